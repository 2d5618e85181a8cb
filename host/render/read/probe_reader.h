// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/picture/pixel_probe.h"
#include "host/render/read/surface_decoder.h"

namespace kilolux {

/// Reads what is known of single pixels of a lit band: surface, layers, cluster and lights.
class ProbeReader {
 public:
    ProbeReader(RenderContext& context, SurfaceDecoder& surfaces)
        : context_(context), surfaces_(surfaces) {}

    /// `rows`: all lights, relative to the last camera. Blocks.
    PixelProbe probe(const LastSample& last, const LightRows& rows, int x, int y);

 private:
    PixelProbe surface_at(const LitBand& band, int x, int y);
    void probe_layers(const LastSample& last, uint x, uint y, PixelProbe& out);
    void probe_lists(const LastSample& last, int x, int y, PixelProbe& out);
    std::vector<bool> seen_lights(const LitBand& band, const ActiveCluster& cluster, uint x,
                                  uint y);

    RenderContext& context_;
    SurfaceDecoder& surfaces_;
};

}  // namespace kilolux
