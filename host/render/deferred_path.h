// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "host/picture/pixel_probe.h"
#include "host/render/blended_pass.h"
#include "host/render/surface_pass.h"
#include "host/stages/lists/count_lights.h"
#include "host/stages/shadows/count_seen.h"
#include "host/stages/tails/tail_errors.h"

namespace kilolux {

/// `deferred`: the scene's surfaces in a G-buffer, lit in OpenCL with the lights of each pixel's
/// active cluster; then what blends, over it.
class DeferredPath {
 public:
    explicit DeferredPath(const PathContext& context);

    /// Radiance of a sample, valid until the next call. `then`: see DeferredLighting. Blocks.
    Radiance light(const Sample& sample, Measured out, const AfterShading& then);

    /// Surfaces and counts of the last light(), for AOVs and views. Blocks.
    DecodedSurfaces pixels(const Camera& camera);

    /// What the last light() shaded, and with which lights. Blocks.
    LitSurfaces lit_surfaces();

    /// What the last light() knows of a pixel; of its lights the indices. Blocks.
    PixelProbe probe(const Camera& camera, int x, int y);

    /// The active clusters of the last light(). Blocks.
    std::vector<ActiveCluster> active_clusters() const;

 private:
    void set_counts(FrameStats& stats);
    LightCounts count_lights();
    CastShadows& counting();
    void count_seen(DecodedSurfaces& out);
    TailErrors& tail_errors();
    std::vector<float> find_variance();
    std::vector<float> find_bound();
    std::vector<bool> seen_lights(const ActiveCluster& cluster, uint x, uint y) const;

    PathContext context_;
    SurfacePass surfaces_;
    DeferredLighting lighting_;
    std::optional<CountLights> count_lights_;  // made when first asked for
    std::optional<CountSeen> count_seen_;      // likewise
    std::optional<TailErrors> tail_errors_;    // likewise
    LightInput lights_;                        // of the last light()
    std::optional<CastShadows> counting_;      // likewise
    std::optional<BlendedPass> blended_;       // none without materials that blend
    GBuffer gbuffer_;                          // of the last light()
};

/// `deferred-all`, the reference of `deferred`: every light at every pixel.
class DeferredAllPath {
 public:
    explicit DeferredAllPath(const PathContext& context);

    // As DeferredPath's.
    Radiance light(const Sample& sample, Measured out, const AfterShading& then);
    DecodedSurfaces pixels(const Camera& camera);
    LitSurfaces lit_surfaces();
    PixelProbe probe(const Camera& camera, int x, int y);

 private:
    PathContext context_;
    SurfacePass surfaces_;
    AllLightsLighting lighting_;
    std::optional<BlendedPass> blended_;
    GBuffer gbuffer_;  // of the last light()
    ClusterGrid grid_{};
};

}  // namespace kilolux
