// SPDX-License-Identifier: Apache-2.0
#include "host/stages/tonemap.h"

#include <cmath>

#include "host/base/srgb.h"

namespace kilolux {
namespace {

constexpr std::string_view kStage = "tonemap";

}  // namespace

Tonemap::Tonemap(const Gpu& gpu, const Tuning& tuning, int tone_curve)
    : gpu_(gpu),
      tuning_(tuning),
      program_(build_program(gpu, kStage, BuildOptions().define("TONE_CURVE", tone_curve))),
      boundary_(gpu, kStage),
      code_(gpu, kStage),
      display_(gpu, kStage) {
    const SrgbBuckets buckets = srgb_buckets();
    upload<float>(gpu_, boundary_.reserve(buckets.boundary.size() * sizeof(float)),
                  buckets.boundary);
    upload<uint>(gpu_, code_.reserve(buckets.code.size() * sizeof(uint)), buckets.code);
}

cl::Buffer Tonemap::enqueue(const Radiance& radiance, float exposure_ev, StageTimer& timer) {
    const std::size_t pixels = std::size_t{radiance.view.stride} * radiance.view.height;
    const cl::Buffer& display = display_.reserve(pixels * sizeof(uint));
    enqueue_to(display, radiance, exposure_ev, timer);
    return display;
}

void Tonemap::enqueue_to(const cl::Buffer& display, const Radiance& radiance, float exposure_ev,
                         StageTimer& timer) {
    in_stage(kStage, [&] {
        const uint pixels = radiance.view.stride * radiance.view.height;
        const auto group = static_cast<std::size_t>(tuning_.light_group);
        const std::size_t items = pixels / static_cast<uint>(gpu_.info.lane_width);
        cl::KernelFunctor<cl::Buffer, uint, float, cl::Buffer, cl::Buffer, cl::Buffer> kernel(
            program_, "tonemap");
        timer.record(kStage, kernel(cl::EnqueueArgs(gpu_.queue, cl::NDRange(round_up(items, group)),
                                                    cl::NDRange(group)),
                                    radiance.planes, pixels, std::exp2(exposure_ev),
                                    boundary_.get(), code_.get(), display));
    });
}

}  // namespace kilolux
