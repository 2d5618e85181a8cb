// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kernels/shared/light.h"

namespace kilolux {

/// Features that only some scenes have. Kernels, shaders and the G-buffer leave out those that a
/// scene lacks.
struct SceneFeatures {
    bool point_lights = false;
    bool spot_lights = false;
    bool directional_lights = false;
    bool area_lights = false;      // lights with a size
    bool metallic = false;         // any metal: tinted specular reflection
    bool emissive = false;         // surfaces that emit light
    bool material = false;         // metallic or emissive: the G-buffer has a plane for them
    bool occlusion = false;        // an occlusion texture, and ambient light that it darkens
    bool specular = false;         // dielectrics that reflect otherwise than 4 %
    bool clearcoat = false;        // surfaces with a clear coat
    bool coat_normals = false;     // coats with other normals than the surfaces below them
    bool sheen = false;            // surfaces with sheen
    bool anisotropy = false;       // surfaces that stretch highlights
    bool transmission = false;     // surfaces that light passes through
    bool unlit = false;            // unlit surfaces among glossy ones: a roughness of 0 marks them
    bool unlit_materials = false;  // unlit surfaces at all
    bool gloss = false;            // roughness and metal are read: not by lambert alone
    bool normal_maps = false;
    bool alpha_mask = false;
    bool alpha_blend = false;
    bool wide_light_index = false;    // more than 65536 lights
    bool shadows = false;             // asked for, and something casts them
    bool light_profiles = false;      // photometric webs: IES files
    bool illuminance = false;         // in place of radiance: ILLUMINANCE of evaluate.h
    int light_groups = 0;             // whose light is stored apart: LIGHT_GROUPS of radiance.h
    float random_ranges = 0.0f;       // RANDOM_RANGES of evaluate.h; 0: none is random
    float light_d_min = LIGHT_D_MIN;  // [m], smaller in small scenes: see light_d_min()
    bool operator==(const SceneFeatures&) const = default;
};

/// One row of the table of features.
struct SceneFeature {
    std::string_view name;  // in the scene plan; empty: not listed
    bool SceneFeatures::*member;
    const char* macro = nullptr;  // 0 or 1 in OpenCL C and GLSL; null: no kernel asks
    bool forceable = false;       // may be compiled in although the scene lacks it
};

std::span<const SceneFeature> scene_feature_table();

/// Macros and values for both languages: the table's rows, and numbers that differ from their
/// default.
std::vector<std::pair<std::string, std::string>> feature_macros(const SceneFeatures& features);

}  // namespace kilolux
