// SPDX-License-Identifier: Apache-2.0
#include "host/stages/picture/tonemap.h"

#include <cmath>
#include <utility>

#include "host/base/srgb.h"

namespace kilolux {
Tonemap::Tonemap(const Gpu& gpu, const Tuning& tuning, int tone_curve)
    : gpu_(gpu),
      tuning_(tuning),
      tone_curve_(tone_curve),
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
    const DisplayTarget to = target(radiance.view, exposure_ev);
    enqueue(radiance, to, timer);
    return to.pixels;
}

void Tonemap::enqueue(const Radiance& radiance, const DisplayTarget& to, StageTimer& timer) {
    const uint pixels = radiance.view.stride * radiance.view.height;
    kernel_.enqueue(items(pixels / static_cast<uint>(gpu_.info.lane_width), tuning_.light_group),
                    timer, radiance.planes, pixels, to.gain, to.bucket_boundary, to.bucket_code,
                    to.pixels);
}

DisplayTarget Tonemap::target(const View& view, float exposure_ev) {
    return target(display_.reserve(std::size_t{view.stride} * view.height), view, exposure_ev);
}

DisplayTarget Tonemap::target(DeviceArray<uint> pixels, const View& view, float exposure_ev) const {
    return {std::move(pixels), view,       tone_curve_, std::exp2(exposure_ev),
            boundary_.get(),   code_.get()};
}

StageWork tonemap_work(const StageCounts& c) {
    return {.bytes_read = kRadianceBytes * c.pixels,
            .bytes_written = kDisplayBytes * c.pixels,
            .launches = 1};
}

}  // namespace kilolux
