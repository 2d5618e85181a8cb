// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "host/lighting/deferred_lighting.h"
#include "host/render/environment_light.h"
#include "host/render/lit_band.h"
#include "host/render/render_context.h"
#include "host/stages/shadows/shadow_origins.h"
#include "host/stages/surfaces/blend_layer.h"
#include "host/surfaces/blended_layers.h"

namespace kilolux {

/// What of the context's surfaces that blend is compiled in and stored.
SurfacePlan layer_plan(const RenderContext& context);

/// Lights surfaces that blend over others, of the deferred renderers: layers as opaque surfaces
/// are, and lays them over the light behind.
class Layers {
 public:
    /// Bytes of a pixel of a layer, beside its G-buffer and lists.
    static constexpr std::size_t kPixelBytes = BlendedLayers::kPixelBytes + Radiance::kPixelBytes;

    /// Both must outlive this.
    Layers(RenderContext& context, BlendedLayers& surfaces);

    /// Draws the first layers in front of the surfaces of `band`. Enqueues only.
    void begin(const Sample& sample, const LitBand& band, StageTimer& timer);

    /// Their pixels, for the frame's lists.
    MorePixels more_pixels();

    /// Lays the first layers over the light of `band`, which is lit and has its background. Blocks
    /// only for shadows, as Visibility does.
    void draw(LitBand& band, EnvironmentLight& environment, StageTimer& timer);

    /// Whether no further ones are expected.
    bool expects_no_more() const { return !first_ || surfaces_.expects_no_more(); }

    /// False where begin() or draw() had too little room; they must run again, and then have it.
    /// Waits for the device.
    bool surfaces_fit() { return surfaces_.fits(); }
    bool lists_fit(StageTimer& timer);

    /// Lays all further layers over the light; false: there were none. Counts all. Blocks. Throws
    /// Error and Interrupted as BlendedLayers::next() does.
    bool draw_rest(LitBand& band, EnvironmentLight& environment, Measured out);

 private:
    void lay(const LayerStack& stack, const ListedLights* others, LitBand& band,
             EnvironmentLight& environment, StageTimer& timer);
    Radiance light(const LightingInput& input, StageTimer& timer);
    std::uint64_t count(const LayerStack& stack, FrameStats& stats) const;

    RenderContext& context_;
    BlendedLayers& surfaces_;
    const LayerStack* first_ = nullptr;         // of the last begin()
    std::optional<ShadowOrigins> origins_;      // with shadows
    std::optional<DeferredLighting> lighting_;  // of `deferred`
    std::optional<AllLightsLighting> all_;      // of `deferred-all`
    BlendLayer blend_;
};

}  // namespace kilolux
