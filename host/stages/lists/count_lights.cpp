// SPDX-License-Identifier: Apache-2.0
#include "host/stages/lists/count_lights.h"

namespace kilolux {
namespace {

constexpr std::string_view kCountLightsStage = "count_lights";

}  // namespace

CountLights::CountLights(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : gpu_(gpu),
      tuning_(tuning),
      kernel_(gpu, build_program(gpu, kCountLightsStage, feature_options(features)),
              kCountLightsStage, "count_lights"),
      evaluated_(gpu, kCountLightsStage),
      covering_(gpu, kCountLightsStage) {}

LightCounts CountLights::enqueue(const LitPixels& lit, StageTimer& timer) {
    const View& view = lit.gbuffer.view;
    const std::size_t pixels = std::size_t{view.stride} * view.height;
    const LightCounts out{evaluated_.reserve(pixels), covering_.reserve(pixels)};
    kernel_.enqueue(pixel_items(view, gpu_.info.lane_width, tuning_.shade_rows), timer,
                    lit.gbuffer.bytes, lit.gbuffer.layout, view, lit.lights.bounds, lit.grid,
                    lit.clusters.offsets, lit.clusters.clusters, lit.clusters.capacity,
                    lit.refined.lists, out.evaluated, out.covering);
    return out;
}

}  // namespace kilolux
