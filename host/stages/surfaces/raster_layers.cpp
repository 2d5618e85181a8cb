// SPDX-License-Identifier: Apache-2.0
#include "host/stages/surfaces/raster_layers.h"

#include <algorithm>
#include <bit>

namespace kilolux {
namespace {

constexpr uint kCounts = 2 * RasterLayers::kMostLayers;

// What a launch of `raster_layers` goes on from.
struct LayerState {
    uint layer_rows, layer, last_layer, is_first;
    DeviceArray<float> keys;
    DeviceArray<uint> ids, drawn;

    void each(auto&& set) const {
        set("layer_rows", layer_rows);
        set("layer", layer);
        set("last_layer", last_layer);
        set("is_first", is_first);
        set("keys", keys);
        set("ids", ids);
        set("drawn", drawn);
    }
};

std::size_t pixels_of(const View& view) { return std::size_t{view.stride} * view.height; }

// The planes of at most `layers` layers of `region`, as many as `pixels` have room for.
View layer_planes(const View& region, std::size_t pixels, std::size_t layers) {
    View out = region;
    out.height = std::max<uint>(std::bit_ceil(region.height), FINE_TILE);
    out.layer_mask = ~(out.height - 1);
    const std::size_t count = std::min(pixels / pixels_of(out), layers);
    return count < 2 ? region : first_layers(out, static_cast<uint>(count));
}

BuildOptions layer_options(const Tuning& tuning) {
    BuildOptions options;
    define_tiles(options, tuning);
    return options;
}

}  // namespace

RasterLayers::RasterLayers(const Gpu& gpu, const Tuning& tuning)
    : gpu_(gpu),
      tuning_(tuning),
      program_(build_program(gpu, kRasterLayersStage, layer_options(tuning))),
      begin_(gpu, program_, kRasterLayersStage, "raster_layers_begin"),
      draw_(gpu, program_, kRasterLayersStage, "raster_layers"),
      keys_(gpu, kRasterLayersStage),
      ids_(gpu, kRasterLayersStage),
      drawn_(gpu, kRasterLayersStage) {}

void RasterLayers::begin(const GBuffer& opaque, const View& region, std::size_t layers,
                         StageTimer& timer) {
    region_ = region;
    layers_ = layer_planes(region, pixels_of(opaque.view), std::min(layers, kMostLayers));
    is_first_ = true;
    begin_.enqueue(begin_.pixel_items(region, tuning_.shade_rows), timer, opaque, region,
                   keys_.reserve(pixels_of(region)), kCounts, drawn_.reserve(kCounts));
}

LayerIds RasterLayers::enqueue(const SurfaceBuffers& scene, const TriangleLists& lists,
                               StageTimer& timer) {
    const uint count = layer_count(layers_);
    LayerState state{
        rows_of_layer(layers_),           0,           count - 1, is_first_ ? 1u : 0u, keys_.get(),
        ids_.reserve(pixels_of(layers_)), drawn_.get()};
    if (!is_first_) {
        gpu_.queue.enqueueFillBuffer(state.drawn.buffer(), 0u, 0, kCounts * sizeof(uint));
    }
    for (; state.layer < count; ++state.layer) {
        draw_.enqueue(draw_.pixel_items(first_layers(layers_, 1), tuning_.shade_rows), timer,
                      region_, scene, lists, state);
        state.last_layer = state.layer;
        state.is_first = 0;
    }
    is_first_ = false;
    return {ids_.get(), layers_};
}

RasterLayers::Drawn RasterLayers::drawn() const {
    const std::vector<uint> counts = download<uint>(gpu_, drawn_.get(), 2 * layer_count(layers_));
    Drawn out;
    for (std::size_t i = 0; i < counts.size() && counts[i] > 0; i += 2) {
        out.pixels.push_back(counts[i]);
        out.may_go_on = counts[i + 1] > 0;
    }
    // All layers that there is room for, and more at pixels of the last.
    out.may_go_on = out.may_go_on && 2 * out.pixels.size() == counts.size();
    return out;
}

}  // namespace kilolux
