// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/measure/bvh.h"
#include "host/measure/parallel_rows.h"
#include "host/measure/surface_samples.h"
#include "host/measure/texture_sampler.h"
#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace kilolux {

struct RayCastOptions {
    double blend_cutoff = 0.0;  // AlphaMode::blend surfaces with less alpha than this are not there
    Progress progress{};
};

/// What rays through the pixels of a camera hit of a scene, all in double: the unquantised
/// G-buffer.
///
/// Written from the mathematics, apart from the rasteriser. Positions lie on the pixel's ray to a
/// few 1e-16 relative; a scene of flat, untextured triangles is exact to rounding. Where it must
/// choose:
/// * Of a back face only what is double sided is seen, with its normal turned round. Mirroring
///   transforms (negative determinant) swap front and back, as glTF says.
/// * Normals: corners' normals interpolated, taken to view space by the inverse transpose, made
/// unit.
///   Without normals: the triangle's. A zero normal is +Z of the view.
/// * Normal maps: tangent frame of the interpolated, unit tangent and normal, bitangent =
/// cross(normal,
///   tangent) * handedness. Without tangents the map is not applied.
/// * Textures: see TextureSampler; derivatives are those at the pixel's centre (Igehy 1999).
/// * Alpha masks take the same filtered sample. Nearer than z_near and farther than z_far is cut
/// away.
/// * KHR_materials_unlit: emissive is the base colour. Ior and specular extensions are not in the
/// model.
class RayCaster {
 public:
    /// Builds the hierarchy and the mip levels. Keeps a reference to the scene.
    explicit RayCaster(const Scene& scene);

    /// Casts width * height rays, on all cores. Positions and normals are in the camera's view
    /// space.
    SurfaceSamples cast(const Camera& camera, int width, int height,
                        const RayCastOptions& options = {}) const;

 private:
    const Scene& scene_;
    Bvh bvh_;
    TextureSampler textures_;
};

}  // namespace kilolux
