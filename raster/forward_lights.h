// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "kernels/shared/cluster_grid.h"
#include "kernels/shared/light.h"
#include "kernels/shared/view.h"
#include "raster/gl_object.h"

namespace kilolux {

/// The light of one frame of forward shading.
struct ForwardLights {
    std::span<const Light> lights;                  // camera-relative
    std::span<const DirectionalLight> directional;  // camera-relative
    float ambient = 0.0f;                           // radiance that falls in from everywhere
    // forward-plus only: lights of coarse cluster c are lists[offsets[c] .. offsets[c + 1]),
    // ascending.
    ClusterGrid grid{};
    std::span<const uint> cluster_offsets;
    std::span<const uint> light_lists;
};

/// A light in view space, as kernels/prepare_lights.cl makes it.
ShadeLight shade_light(const View& view, const Light& light);

/// Lights in buffers that forward.frag reads.
class ForwardLightBuffers {
 public:
    ForwardLightBuffers();

    void upload(const ForwardLights& lights, const View& view);

    /// Binds uniform block 1 and storage blocks 0 to 3.
    void bind() const;

 private:
    GlBuffer frame_, lights_, directional_, cluster_offsets_, light_lists_;
};

}  // namespace kilolux
