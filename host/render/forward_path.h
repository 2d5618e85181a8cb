// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "host/picture/pixel_probe.h"
#include "host/render/blended_pass.h"
#include "host/render/surface_pass.h"
#include "raster/solid_pass.h"

namespace kilolux {

/// `forward` and `forward-plus`: OpenGL shades where it draws. Forward takes every light for every
/// fragment, in the scene's order; forward-plus draws depth first and takes the coarse lists that
/// OpenCL makes. A G-buffer is drawn only for AOVs, views and counts.
class ForwardPath {
 public:
    explicit ForwardPath(const PathContext& context);

    /// As DeferredPath::light. evaluations_per_pixel is -1 unless FrameRequest::counts asks for it:
    /// for forward, lights times fragments shaded at a pixel; useful ones are not counted.
    Radiance light(const Sample& sample, Measured out, const AfterShading& then);

    /// Surfaces and counts of the last light(), for AOVs and views. Blocks.
    DecodedSurfaces pixels(const Camera& camera);

    /// As DeferredPath::probe; draws a G-buffer for it.
    PixelProbe probe(const Camera& camera, int x, int y);

 private:
    HostCoarseLists make_lists(const Sample& sample, const View& view, Measured out);
    SurfacePass& drawn_surfaces(const Camera& camera);  // into gbuffer_
    std::vector<uint> evaluated(const Camera& camera, const DecodedSurfaces& surfaces);

    PathContext context_;
    bool clustered_;
    ForwardPass forward_;
    std::optional<CoarseLightLists> coarse_;  // forward-plus only
    GrowingArray<float> radiance_;
    std::optional<SurfacePass> surfaces_;  // made when first asked for
    std::optional<OverdrawPass> overdraw_;
    GBuffer gbuffer_;  // of surfaces_
    // Of the last light().
    ClusterGrid grid_{};
    HostCoarseLists lists_;
    uint local_lights_ = 0;
};

}  // namespace kilolux
