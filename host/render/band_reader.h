// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "host/picture/decoded_surfaces.h"
#include "host/picture/pixel_probe.h"
#include "host/render/frame_stages.h"
#include "host/stages/lists/count_lights.h"
#include "host/stages/shadows/count_seen.h"
#include "host/stages/surfaces/decode_gbuffer.h"
#include "host/stages/tails/tail_errors.h"
#include "raster/solid_pass.h"

namespace kilolux {

/// The sample that a frame lit last, on the device.
struct LastSample {
    LitBand& band;
    FrameStages& stages;
    const Camera& camera;
};

/// Reads counts, AOVs, surfaces and single pixels of a lit band. Their kernels are built when first
/// asked for. All functions block.
class BandReader {
 public:
    explicit BandReader(RenderContext& context) : context_(context) {}

    /// Lights evaluated a pixel and what FrameRequest::counts and shadow_counts ask for.
    void count(const LastSample& last, FrameStats& stats);

    /// Surfaces and counts, for AOVs and views.
    DecodedSurfaces pixels(const LastSample& last);

    /// What was shaded, and with which lights. Throws Error for the forward renderers.
    LitSurfaces lit_surfaces(const LastSample& last);

    /// What is known of a pixel. `rows`: all lights, relative to the last camera.
    PixelProbe probe(const LastSample& last, const LightRows& rows, int x, int y);

    /// Fragments that are shaded at each pixel.
    std::vector<float> overdraw(const Camera& camera, DrawOrder order);

 private:
    LightCounts count_lights(const LastSample& last);
    void count_evaluated(const LastSample& last, DecodedSurfaces& out);
    void count_seen(const LastSample& last, DecodedSurfaces& out);
    void add_layers(const LastSample& last, DecodedSurfaces& out);
    void each_layer(const LastSample& last, const std::function<void(const LayerStack&)>& visit);
    void probe_layers(const LastSample& last, uint x, uint y, PixelProbe& out);
    std::vector<uint> forward_evaluated(const LastSample& last, const DecodedSurfaces& surfaces);
    std::vector<float> variance(const LastSample& last);
    std::vector<float> bound(const LastSample& last);
    PixelProbe surface_at(const LitBand& band, int x, int y);
    void probe_lists(const LastSample& last, int x, int y, PixelProbe& out);
    std::vector<bool> seen_lights(const LitBand& band, const ActiveCluster& cluster, uint x,
                                  uint y);
    DecodeGBuffer& decoder();
    DecodeGBuffer& layer_decoder();
    std::vector<float> illuminance(const LastSample& last);
    TailErrors& tail_errors();

    RenderContext& context_;
    std::optional<DecodeGBuffer> decode_, decode_layers_;
    std::optional<CountLights> count_lights_;
    std::optional<CountSeen> count_seen_;
    std::optional<CastShadows> counting_;
    std::optional<TailErrors> tail_errors_;
    std::optional<Shade> illuminance_;
    std::optional<ShadeAll> illuminance_of_all_;
    std::optional<OverdrawPass> overdraw_;
};

}  // namespace kilolux
