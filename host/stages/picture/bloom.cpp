// SPDX-License-Identifier: Apache-2.0
#include "host/stages/picture/bloom.h"

#include <algorithm>

namespace kilolux {
namespace {

// The coarsest level is at least half this high and wide [pixel], so that a blur stays local.
constexpr uint kSmallestHalved = 16;
// Share that each wider blur has in the next finer one: weights fall by 0.7 an octave, chosen for a
// core with a wide, faint skirt.
constexpr float kScatter = 0.7f;

// Width, height and stride of a level [pixel].
uint4 level_size(uint width, uint height) { return {width, height, (width + 15u) / 16u * 16u, 0u}; }

std::vector<uint4> pyramid(const View& view) {
    std::vector<uint4> sizes = {{view.width, view.height, view.stride, 0u}};
    while (std::min(sizes.back().x, sizes.back().y) >= kSmallestHalved) {
        const uint4 last = sizes.back();
        sizes.push_back(level_size((last.x + 1) / 2, (last.y + 1) / 2));
    }
    return sizes;
}

}  // namespace

Bloom::Bloom(const Gpu& gpu)
    : gpu_(gpu),
      program_(build_program(gpu, kBloomStage)),
      down_(gpu, program_, kBloomStage, "bloom_down"),
      up_(gpu, program_, kBloomStage, "bloom_up") {}

Radiance Bloom::enqueue(const Radiance& radiance, float share, StageTimer& timer) {
    const std::vector<uint4> sizes = pyramid(radiance.view);
    if (share <= 0.0f || sizes.size() == 1) return radiance;
    while (levels_.size() < sizes.size()) levels_.emplace_back(gpu_, kBloomStage);
    const auto work = [&](std::size_t i) {
        return WorkSize{cl::NDRange(sizes[i].z / down_.lanes(), sizes[i].y, 3), cl::NullRange};
    };
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        levels_[i].reserve(std::size_t{3} * sizes[i].y * sizes[i].z);
    }
    const auto level = [&](std::size_t i) { return i == 0 ? radiance.planes : levels_[i].get(); };
    for (std::size_t i = 1; i < sizes.size(); ++i) {
        down_.enqueue(work(i), timer, level(i - 1), sizes[i - 1], sizes[i], level(i));
    }
    for (std::size_t i = sizes.size() - 1; i > 0; --i) {
        up_.enqueue(work(i - 1), timer, level(i), sizes[i], level(i - 1), sizes[i - 1],
                    i == 1 ? share : kScatter, levels_[i - 1].get());
    }
    return Radiance{levels_[0].get(), radiance.view};
}

// The two finest levels of the pyramid, which move 0.94 of all its bytes: down reads a level and
// writes a quarter of it, up reads that quarter and the level and writes the level.
StageWork bloom_work(const StageCounts& c) {
    constexpr double kLevels = 1.0 + 0.25;
    return {.bytes_read = kLevels * (1.0 + 0.25 + 1.0) * kRadianceBytes * c.pixels,
            .bytes_written = kLevels * (0.25 + 1.0) * kRadianceBytes * c.pixels,
            .launches = 4};
}

}  // namespace kilolux
