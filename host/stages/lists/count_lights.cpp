// SPDX-License-Identifier: Apache-2.0
#include "host/stages/lists/count_lights.h"

namespace kilolux {

CountLights::CountLights(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : tuning_(tuning),
      kernel_(gpu, build_program(gpu, kCountLightsStage, feature_options(features)),
              kCountLightsStage, "count_lights"),
      evaluated_(gpu, kCountLightsStage),
      covering_(gpu, kCountLightsStage) {}

LightCounts CountLights::enqueue(const LitPixels& lit, StageTimer& timer) {
    const View& view = lit.gbuffer.view;
    const std::size_t pixels = std::size_t{view.stride} * view.height;
    LightCounts out{evaluated_.reserve(pixels), covering_.reserve(pixels)};
    kernel_.enqueue(kernel_.pixel_items(view, tuning_.shade_rows), timer, lit, out.evaluated,
                    out.covering);
    return out;
}

}  // namespace kilolux
