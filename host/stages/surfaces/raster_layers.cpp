// SPDX-License-Identifier: Apache-2.0
#include "host/stages/surfaces/raster_layers.h"

#include <array>
#include <vector>

namespace kilolux {
namespace {

// What a launch of `raster_layers` goes on from.
struct LayerState {
    uint is_first;
    DeviceArray<float> keys;
    DeviceArray<uint> ids, drawn;

    void each(auto&& set) const {
        set("is_first", is_first);
        set("keys", keys);
        set("ids", ids);
        set("drawn", drawn);
    }
};

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

void RasterLayers::begin(const GBuffer& opaque, StageTimer& timer) {
    view_ = opaque.view;
    is_first_ = true;
    const std::size_t size = std::size_t{view_.stride} * view_.height;
    begin_.enqueue(begin_.pixel_items(view_, tuning_.shade_rows), timer, opaque,
                   keys_.reserve(size), ids_.reserve(size));
}

DeviceArray<uint> RasterLayers::enqueue(const SurfaceBuffers& scene, const TriangleLists& lists,
                                        StageTimer& timer) {
    constexpr std::array<uint, 2> kNone{};
    upload<uint>(gpu_, drawn_.reserve(kNone.size()), kNone);
    draw_.enqueue(draw_.pixel_items(view_, tuning_.shade_rows), timer, view_, scene, lists,
                  LayerState{is_first_ ? 1u : 0u, keys_.get(), ids_.get(), drawn_.get()});
    is_first_ = false;
    return ids_.get();
}

RasterLayers::Drawn RasterLayers::drawn() const {
    const std::vector<uint> counts = download<uint>(gpu_, drawn_.get(), 2);
    return {counts[0], counts[1] > 0};
}

}  // namespace kilolux
