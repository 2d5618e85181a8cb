// SPDX-License-Identifier: Apache-2.0
#include "host/render/whole_picture.h"

namespace kilolux {
namespace {

bool blooms(const RenderSettings& settings) { return settings.bloom > 0.0f; }

// Bytes of a pixel of the stages that are on.
std::size_t stage_bytes(const RenderSettings& settings) {
    return blooms(settings) ? Bloom::kPixelBytes : 0;
}

}  // namespace

bool needs_whole_picture(const RenderSettings& settings) { return stage_bytes(settings) > 0; }

// Besides, the light of all bands is kept, and the display picture made from it.
std::size_t whole_picture_pixel_bytes(const RenderSettings& settings) {
    if (!needs_whole_picture(settings)) return 0;
    return Radiance::kPixelBytes + DisplayTarget::kPixelBytes + stage_bytes(settings);
}

void WholePictureStages::set(const Gpu& gpu, const RenderSettings& settings) {
    if (blooms(settings) && !bloom_) bloom_.emplace(gpu);
}

Radiance WholePictureStages::enqueue(Radiance light, const RenderSettings& settings,
                                     StageTimer& timer) {
    if (blooms(settings)) light = bloom_->enqueue(light, settings.bloom, timer);
    return light;
}

}  // namespace kilolux
