// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/measure/reference/bvh.h"
#include "host/measure/reference/camera_rays.h"
#include "host/measure/reference/surface_samples.h"
#include "host/measure/reference/texture_sampler.h"

namespace kilolux {

/// A ray's hit on a triangle of a scene. Holds references only.
struct SurfaceHit {
    const Scene& scene;
    const TextureSampler& textures;
    const BvhTriangle& triangle;
    const RayHit& hit;
    const PixelRay& ray;  // in world space
};

/// The material of the triangle's mesh, or glTF's default one.
const Material& material_of(const SurfaceHit& hit);

const Mesh& mesh_of(const SurfaceHit& hit);

/// Whether the ray arrives on the front: the side from which the corners are counter-clockwise in
/// object space.
bool front_facing(const SurfaceHit& hit);

/// Base colour and alpha: factor times texture times vertex colour.
glm::dvec4 base_color_at(const SurfaceHit& hit);

/// The share that covers what is behind: 0 or 1 but for AlphaMode::blend.
double coverage_at(const SurfaceHit& hit);

/// All attributes at the hit. The normal is in world space and faces the ray; the position stays 0.
SurfaceSample surface_at(const SurfaceHit& hit);

}  // namespace kilolux
