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
      lights_(gpu, kStage),
      bounds_(gpu, kStage),
      extents_(gpu, kStage),
      directional_(gpu, kStage) {}

PreparedLights PrepareLights::enqueue(const LightInput& input, const View& view,
                                      const ClusterGrid& grid, StageTimer& timer) {
    return in_stage(kStage, [&] {
        PreparedLights out;
        out.count = input.count;
        out.directional_count = input.directional_count;
        out.lights = lights_.reserve(input.count * sizeof(ShadeLight));
        out.bounds = bounds_.reserve(input.count * sizeof(float4));
        out.extents = extents_.reserve(input.count * sizeof(LightExtent));
        out.directional = directional_.reserve(input.directional_count * sizeof(DirectionalLight));
        if (input.count > 0) {
            const auto group = static_cast<std::size_t>(tuning_.light_group);
            const std::size_t items = (input.count + static_cast<uint>(gpu_.info.lane_width) - 1) /
                                      static_cast<uint>(gpu_.info.lane_width);
            cl::KernelFunctor<cl::Buffer, uint, View, ClusterGrid, cl::Buffer, cl::Buffer,
                              cl::Buffer>
                kernel(program_, "prepare_lights");
            timer.record(
                kStage,
                kernel(cl::EnqueueArgs(gpu_.queue, cl::NDRange(round_up(items, group)),
                                       cl::NDRange(group)),
                       input.lights, input.count, view, grid, out.lights, out.bounds, out.extents));
        }
        if (input.directional_count > 0) {
            cl::KernelFunctor<cl::Buffer, View, cl::Buffer> kernel(program_,
                                                                   "prepare_directional_lights");
            timer.record(kStage,
                         kernel(cl::EnqueueArgs(gpu_.queue, cl::NDRange(input.directional_count),
                                                cl::NDRange(1)),
                                input.directional, view, out.directional));
        }
        return out;
    });
}

}  // namespace kilolux
