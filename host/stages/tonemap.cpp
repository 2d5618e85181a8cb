// SPDX-License-Identifier: Apache-2.0
#include "host/stages/tonemap.h"

#include <cmath>

#include "host/base/srgb.h"

namespace kilolux {
namespace {

constexpr std::string_view kTonemapStage = "tonemap";

}  // namespace

Tonemap::Tonemap(const Gpu& gpu, const Tuning& tuning, int tone_curve)
    : gpu_(gpu),
      tuning_(tuning),
      kernel_(gpu,
              build_program(gpu, kTonemapStage, BuildOptions().define("TONE_CURVE", tone_curve)),
              kTonemapStage, "tonemap"),
      boundary_(gpu, kTonemapStage),
      code_(gpu, kTonemapStage),
      display_(gpu, kTonemapStage) {
    const SrgbBuckets buckets = srgb_buckets();
    upload<float>(gpu_, boundary_.reserve(buckets.boundary.size()), buckets.boundary);
    upload<uint>(gpu_, code_.reserve(buckets.code.size()), buckets.code);
}

DeviceArray<uint> Tonemap::enqueue(const Radiance& radiance, float exposure_ev, StageTimer& timer) {
    const DeviceArray<uint> display =
        display_.reserve(std::size_t{radiance.view.stride} * radiance.view.height);
    enqueue_to(display, radiance, exposure_ev, timer);
    return display;
}

void Tonemap::enqueue_to(const DeviceArray<uint>& display, const Radiance& radiance,
                         float exposure_ev, StageTimer& timer) {
    const uint pixels = radiance.view.stride * radiance.view.height;
    kernel_.enqueue(items(pixels / static_cast<uint>(gpu_.info.lane_width), tuning_.light_group),
                    timer, radiance.planes, pixels, std::exp2(exposure_ev), boundary_.get(),
                    code_.get(), display);
}

}  // namespace kilolux
