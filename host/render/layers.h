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

    explicit Layers(RenderContext& context);

    /// Lays `layers`, which have begun, over the light of `band`, which is lit and has its
    /// background. Blocks. Throws Error and Interrupted as BlendedLayers::each() does.
    void draw(BlendedLayers& layers, const LitBand& band, EnvironmentLight& environment,
              Measured out);

 private:
    Radiance light(const LitBand& layers, const LitBand& behind, StageTimer& timer);

    RenderContext& context_;
    std::optional<ShadowOrigins> origins_;      // with shadows
    std::optional<DeferredLighting> lighting_;  // of `deferred`
    std::optional<AllLightsLighting> all_;      // of `deferred-all`
    BlendLayer blend_;
};

}  // namespace kilolux
