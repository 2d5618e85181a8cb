// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/measure/reference/bvh.h"
#include "host/measure/reference/camera_rays.h"
#include "host/measure/reference/surface_samples.h"
#include "host/measure/reference/texture_sampler.h"

namespace kilolux {

/// A ray's meeting with a triangle of a scene. Refers to what it was made of.
struct SurfaceHit {
    const Scene& scene;
    const TextureSampler& textures;
    const BvhTriangle& triangle;
    const RayHit& hit;
    const PixelRay& ray;  // in world space
};

/// The material of the triangle's mesh, or glTF's default one.
const Material& material_of(const SurfaceHit& hit);

/// Whether the ray comes from the side on which the triangle's corners turn counter-clockwise, seen
/// in object space.
bool front_facing(const SurfaceHit& hit);

/// Base colour and alpha: factor times texture times vertex colour.
glm::dvec4 base_color_at(const SurfaceHit& hit);

/// All attributes at the hit, the normal in world space and turned to the side the ray comes from,
/// the position left 0.
SurfaceSample surface_at(const SurfaceHit& hit);

}  // namespace kilolux
