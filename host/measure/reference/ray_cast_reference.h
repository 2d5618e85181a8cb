// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "host/measure/metrics/parallel_rows.h"
#include "host/measure/reference/bvh.h"
#include "host/measure/reference/hit_surface.h"
#include "host/measure/reference/surface_samples.h"
#include "host/measure/reference/texture_sampler.h"
#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace kilolux {

/// Casts rays through the pixels of a camera, all in double: the G-buffer without quantisation.
///
/// Independent of the rasteriser. Positions lie on the pixel's ray to a few 1e-16 relative; a scene
/// of flat, untextured triangles is exact to rounding. Conventions:
/// * Back faces are seen only of double-sided materials, with their normal flipped. Transforms with
///   a negative determinant swap front and back (glTF 2.0, 3.7.4).
/// * Normals: those of the corners, transformed by the inverse transpose, normalised, interpolated,
///   normalised. Without normals: the triangle's. A zero normal becomes +Z of the view.
/// * Normal maps: MikkTSpace's basis, interpolated and not normalised, bitangent = cross(normal,
///   tangent) * handedness, mirrored with the object. Without tangents the map is not applied.
/// * Textures: see TextureSampler; derivatives are those at the pixel's centre (Igehy 1999).
/// * Alpha masks use the same filtered sample. Hits nearer than z_near or farther than z_far are
///   left out.
/// * KHR_materials_unlit: emissive is the base colour.
class RayCaster {
 public:
    /// Builds the hierarchy and the mip levels. Keeps a reference to the scene.
    explicit RayCaster(const Scene& scene);

    /// Casts width * height rays, on all cores. Positions and normals are in the camera's view
    /// space. Surfaces that blend are left out, as in a G-buffer.
    SurfaceSamples cast(const Camera& camera, int width, int height,
                        const OnProgress& progress = {}) const {
        return std::move(cast_layers(camera, width, height, progress).front());
    }

    /// The same, and each pixel's surfaces that blend over it, from far to near. Of surfaces of one
    /// depth those drawn first are nearer.
    std::vector<SurfaceSamples> cast_layers(const Camera& camera, int width, int height,
                                            const OnProgress& progress = {}) const;

 private:
    SurfaceHit hit_of(const RayHit& hit, const PixelRay& ray) const;
    std::vector<RayHit> surfaces_along(const PixelRay& ray, const Camera& camera) const;

    const Scene& scene_;
    Bvh bvh_;
    TextureSampler textures_;
};

}  // namespace kilolux
