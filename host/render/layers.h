// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "host/lighting/deferred_lighting.h"
#include "host/render/environment_light.h"
#include "host/render/lit_band.h"
#include "host/render/render_context.h"
#include "host/stages/shadows/shadow_origins.h"
#include "host/stages/surfaces/bin_triangles.h"
#include "host/stages/surfaces/blend_layer.h"
#include "host/stages/surfaces/raster_layers.h"

namespace kilolux {

/// Surfaces that blend over others, of the deferred renderers. Each layer of fragments, from far to
/// near, becomes a G-buffer, is lit as opaque surfaces are, and is laid over the light behind it.
/// The order in the scene does not matter, and the number of layers has no limit; each costs as the
/// lighting of a picture does.
class Layers {
 public:
    /// Bytes of a pixel of a layer, beside its G-buffer and lists.
    static constexpr std::size_t kPixelBytes = RasterLayers::kPixelBytes + Radiance::kPixelBytes;

    explicit Layers(RenderContext& context);

    /// Lays them over the light of `band`, which is lit and has its background. Blocks. Throws
    /// Error as the stages do, Interrupted between layers.
    void draw(const Sample& sample, const LitBand& band, EnvironmentLight& environment,
              Measured out);

 private:
    TriangleLists list_triangles(const SurfaceBuffers& scene, std::span<const Draw> draws,
                                 const View& view, StageTimer& timer);
    Radiance light(const LitBand& layer, StageTimer& timer);

    RenderContext& context_;
    ScenePlan plan_;
    DrawList draw_list_;
    BinTriangles bin_;
    RasterLayers raster_;
    ResolveSurfaces resolve_;
    std::optional<ShadowOrigins> origins_;      // with shadows
    std::optional<DeferredLighting> lighting_;  // of `deferred`
    std::optional<AllLightsLighting> all_;      // of `deferred-all`
    BlendLayer blend_;
};

}  // namespace kilolux
