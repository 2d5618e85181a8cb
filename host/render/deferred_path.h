// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "host/lighting/light_lists.h"
#include "host/picture/pixel_probe.h"
#include "host/render/surface_pass.h"
#include "host/stages/count_lights.h"
#include "host/stages/shade.h"
#include "raster/forward_pass.h"

namespace kilolux {

/// `deferred` and its reference `deferred-all`: the scene's surfaces in a G-buffer, shaded in
/// OpenCL with the lights of each pixel's active cluster, or with every light; then what blends,
/// over it.
class DeferredPath {
 public:
    explicit DeferredPath(const RenderContext& context);

    /// Radiance of a sample, valid until the next call. Sets the counts of `stats` and adds the
    /// host's stages to it; `timer` gets the device's.
    Radiance light(const SampleInput& sample, StageTimer& timer, FrameStats& stats);

    /// Surfaces and counts of the last light(), for AOVs and views. Blocks.
    DecodedSurfaces pixels();

    /// What the last light() shaded, and with which lights. Blocks.
    LitSurfaces lit_surfaces();

    /// What the last light() knows of a pixel; of its lights the indices. Blocks.
    PixelProbe probe(int x, int y);

    /// The active clusters of the last light(), without `deferred-all`. Blocks.
    std::vector<ActiveCluster> active_clusters() const { return list_stages_.clusters(lists_); }

 private:
    Radiance light_from_lists(const SampleInput& sample, StageTimer& timer, FrameStats& stats);
    Radiance light_from_all(const SampleInput& sample, StageTimer& timer, FrameStats& stats);
    void blend(const SampleInput& sample, const Radiance& radiance, FrameStats& stats);
    LightCounts count_lights();

    RenderContext context_;
    bool all_lights_;
    SurfacePass surfaces_;
    PrepareLights prepare_;
    ListStages list_stages_;
    Shade shade_;
    std::optional<ShadeAll> shade_all_;  // made when first used
    CountLights count_lights_;
    std::optional<ForwardPass> blended_;  // none without materials that blend
    // Of the last light().
    GBuffer gbuffer_;
    ClusterGrid grid_{};
    LightLists lists_;
    uint local_lights_ = 0;
};

}  // namespace kilolux
