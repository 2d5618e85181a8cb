// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "host/picture/decoded_surfaces.h"
#include "host/render/read/probe_reader.h"
#include "host/stages/lists/count_lights.h"
#include "host/stages/shadows/count_seen.h"
#include "host/stages/tails/tail_errors.h"
#include "raster/solid_pass.h"

namespace kilolux {

/// Reads counts, AOVs, surfaces and single pixels of a lit band. Their kernels are built when first
/// asked for. All functions block.
class BandReader {
 public:
    explicit BandReader(RenderContext& context)
        : context_(context), surfaces_(context), probes_(context, surfaces_) {}
    BandReader(const BandReader&) = delete;
    BandReader& operator=(const BandReader&) = delete;

    /// Lights evaluated a pixel and what FrameRequest::counts and shadow_counts ask for.
    void count(const LastSample& last, FrameStats& stats);

    /// Surfaces and counts, for AOVs and views.
    DecodedSurfaces pixels(const LastSample& last);

    /// What was shaded, and with which lights. Throws Error for the forward renderers.
    LitSurfaces lit_surfaces(const LastSample& last);

    /// What is known of a pixel. `rows`: all lights, relative to the last camera.
    PixelProbe probe(const LastSample& last, const LightRows& rows, int x, int y) {
        return probes_.probe(last, rows, x, y);
    }

    /// Fragments that are shaded at each pixel.
    std::vector<float> overdraw(const Camera& camera, DrawOrder order);

 private:
    LightCounts count_lights(const LastSample& last);
    void count_evaluated(const LastSample& last, DecodedSurfaces& out);
    void count_seen(const LastSample& last, DecodedSurfaces& out);
    void add_layers(const LastSample& last, DecodedSurfaces& out);
    std::vector<uint> forward_evaluated(const LastSample& last, const DecodedSurfaces& surfaces);
    std::vector<float> variance(const LastSample& last);
    std::vector<float> bound(const LastSample& last);
    std::vector<float> illuminance(const LastSample& last);
    TailErrors& tail_errors();

    RenderContext& context_;
    SurfaceDecoder surfaces_;
    ProbeReader probes_;
    std::optional<CountLights> count_lights_;
    std::optional<CountSeen> count_seen_;
    std::optional<CastShadows> counting_;
    std::optional<TailErrors> tail_errors_;
    std::optional<Shade> illuminance_;
    std::optional<ShadeAll> illuminance_of_all_;
    std::optional<OverdrawPass> overdraw_;
};

}  // namespace kilolux
