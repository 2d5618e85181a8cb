// SPDX-License-Identifier: Apache-2.0
#include "host/stages/prepare_lights.h"

namespace kilolux {
namespace {

constexpr std::string_view kStage = "prepare_lights";

}  // namespace

PrepareLights::PrepareLights(const Gpu& gpu, const Tuning& tuning)
    : gpu_(gpu),
      tuning_(tuning),
      program_(build_program(gpu, kStage)),
      prepare_(gpu, program_, kStage, "prepare_lights"),
      prepare_directional_(gpu, program_, kStage, "prepare_directional_lights"),
      lights_(gpu, kStage),
      bounds_(gpu, kStage),
      extents_(gpu, kStage),
      directional_(gpu, kStage) {}

PreparedLights PrepareLights::enqueue(const LightInput& input, const View& view,
                                      const ClusterGrid& grid, StageTimer& timer) {
    PreparedLights out;
    out.count = input.count;
    out.directional_count = input.directional_count;
    out.lights = lights_.reserve(input.count);
    out.bounds = bounds_.reserve(input.count);
    out.extents = extents_.reserve(input.count);
    out.directional = directional_.reserve(input.directional_count);
    if (input.count > 0) {
        const auto lanes = static_cast<std::size_t>(gpu_.info.lane_width);
        prepare_.enqueue(items((input.count + lanes - 1) / lanes, tuning_.light_group), timer,
                         input.lights, input.count, view, grid, out.lights, out.bounds,
                         out.extents);
    }
    if (input.directional_count > 0) {
        prepare_directional_.enqueue(items(input.directional_count, 1), timer, input.directional,
                                     view, out.directional);
    }
    return out;
}

}  // namespace kilolux
