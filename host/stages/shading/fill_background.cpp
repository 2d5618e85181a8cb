// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shading/fill_background.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kilolux {
namespace {

// Appends the level of half the size: means of 2x2 texels.
uint4 halve(std::vector<float>& texels, const uint4& from) {
    const uint4 to{from.x / 2, from.y / 2, from.z + from.x * from.y, 0};
    texels.reserve(texels.size() + std::size_t{3} * to.x * to.y);
    const auto at = [&](uint x, uint y, uint c) {
        return texels[3 * (std::size_t{from.z} + std::size_t{y} * from.x + x) + c];
    };
    for (uint y = 0; y < to.y; ++y) {
        for (uint x = 0; x < to.x; ++x) {
            for (uint c = 0; c < 3; ++c) {
                const float upper = at(2 * x, 2 * y, c) + at(2 * x + 1, 2 * y, c);
                const float lower = at(2 * x, 2 * y + 1, c) + at(2 * x + 1, 2 * y + 1, c);
                texels.push_back(0.25f * (upper + lower));
            }
        }
    }
    return to;
}

}  // namespace

FillBackground::FillBackground(const Gpu& gpu, const Tuning& tuning)
    : gpu_(gpu),
      tuning_(tuning),
      kernel_(gpu, build_program(gpu, kFillBackgroundStage), kFillBackgroundStage,
              "fill_background"),
      texels_(gpu, kFillBackgroundStage) {}

void FillBackground::set_image(std::span<const float> rgb, uint width, uint height) {
    std::vector<float> texels(rgb.begin(), rgb.end());
    levels_ = {{width, height, 0, 0}};
    while (levels_.back().x % 2 == 0 && levels_.back().y % 2 == 0) {
        levels_.push_back(halve(texels, levels_.back()));
    }
    upload<float>(gpu_, texels_.reserve(texels.size()), texels);
}

// Chosen by the angle of a pixel in the middle of the picture, where it is largest.
uint4 FillBackground::level_for(const View& view) const {
    if (view.orthographic != 0u) return levels_.front();
    const double pixel = std::abs(double{view.ray.x});  // [rad]
    const double texel = 2.0 * std::numbers::pi / levels_.front().x;
    const double octaves = std::clamp(std::floor(std::log2(pixel / texel)), 0.0, 32.0);
    return levels_[std::min(static_cast<std::size_t>(octaves), levels_.size() - 1)];
}

void FillBackground::enqueue(const GBuffer& gbuffer, const Radiance& radiance, StageTimer& timer) {
    const View& view = radiance.view;
    kernel_.enqueue(kernel_.pixel_items(view, tuning_.shade_rows), timer, gbuffer, 0u,
                    texels_.get(), level_for(view), radiance.planes);
}

void FillBackground::enqueue_everywhere(const Radiance& radiance, StageTimer& timer) {
    const View& view = radiance.view;
    const GBuffer none{{}, {}, view};
    kernel_.enqueue(kernel_.pixel_items(view, tuning_.shade_rows), timer, none, 1u, texels_.get(),
                    level_for(view), radiance.planes);
}

// Neighbouring pixels share texels.
StageWork fill_background_work(const StageCounts& c) {
    const double open = c.pixels - c.surface_pixels;
    return {.bytes_read = sizeof(float) * c.pixels + kRadianceBytes * open,
            .bytes_written = kRadianceBytes * open,
            .launches = 1};
}

}  // namespace kilolux
