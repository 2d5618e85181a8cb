// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/material_row.h"
#include "host/scene/scene.h"
#include "raster/gl_program.h"

namespace kilolux {

/// What drawing a mesh with its material takes, as bits: a shader variant's key. Texture uses
/// (USE_*) have three bits each: present, second uv set, transformed.
enum Feature : uint {
    kFeatureTexture = 1u << 0,                  // << use
    kFeatureTexcoord1 = 1u << USE_COUNT,        // << use
    kFeatureTransform = 1u << (2 * USE_COUNT),  // << use
    kFeatureVertexColor = 1u << (3 * USE_COUNT),
    kFeatureAlphaMask = 2u << (3 * USE_COUNT),
    kFeatureDoubleSided = 4u << (3 * USE_COUNT),
    kFeatureUnlit = 8u << (3 * USE_COUNT),
    kFeatureSharedOcclusion =
        16u << (3 * USE_COUNT),  // occlusion is the red of the metallic-roughness texture
    kFeatureNoSurface = 32u << (3 * USE_COUNT),  // the mesh has no normals: only coverage is drawn
};

/// Feature bits of a mesh drawn with a material. A normal map needs the mesh's tangents.
uint features_of(const Mesh& mesh, const Material& material);

/// The bits without those of some texture use.
uint without_texture(uint features, int use);

/// The bits that decide whether a fragment is kept at all: what a pass without colour looks at.
uint coverage_features();

/// What a pass reads of geometry.vert, whatever the material.
struct PassInputs {
    bool surface = true;  // normals, and what else materials read; else coverage alone
    bool position = false;
    bool ids = false;
};

/// All that the shaders geometry.vert and material.glsl ask.
Defines feature_defines(uint features, const PassInputs& inputs);

}  // namespace kilolux
