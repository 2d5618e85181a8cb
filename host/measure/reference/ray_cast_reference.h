// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/measure/metrics/parallel_rows.h"
#include "host/measure/reference/bvh.h"
#include "host/measure/reference/surface_samples.h"
#include "host/measure/reference/texture_sampler.h"
#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace kilolux {

/// What rays through the pixels of a camera hit of a scene, all in double: the unquantised
/// G-buffer.
///
/// Written from the mathematics, apart from the rasteriser. Positions lie on the pixel's ray to a
/// few 1e-16 relative; a scene of flat, untextured triangles is exact to rounding. Where it must
/// choose:
/// * Of a back face only what is double sided is seen, with its normal turned round. Mirroring
///   transforms (negative determinant) swap front and back, as glTF says.
/// * Normals: the corners', taken to the world by the inverse transpose, made unit, interpolated,
///   made unit. Without normals: the triangle's. A zero normal is +Z of the view.
/// * Normal maps: MikkTSpace's basis, interpolated and not made unit, bitangent = cross(normal,
///   tangent) * handedness, mirrored with the object. Without tangents the map is not applied.
/// * Textures: see TextureSampler; derivatives are those at the pixel's centre (Igehy 1999).
/// * Alpha masks take the same filtered sample. Surfaces of AlphaMode::blend are not seen: a
///   G-buffer holds none. Nearer than z_near and farther than z_far is cut away.
/// * KHR_materials_unlit: emissive is the base colour. The ior and specular extensions are not in
///   the model.
class RayCaster {
 public:
    /// Builds the hierarchy and the mip levels. Keeps a reference to the scene.
    explicit RayCaster(const Scene& scene);

    /// Casts width * height rays, on all cores. Positions and normals are in the camera's view
    /// space.
    SurfaceSamples cast(const Camera& camera, int width, int height,
                        const OnProgress& progress = {}) const;

 private:
    const Scene& scene_;
    Bvh bvh_;
    TextureSampler textures_;
};

}  // namespace kilolux
