// SPDX-License-Identifier: Apache-2.0
#include "host/stages/bloom.h"

#include <algorithm>

namespace kilolux {
namespace {

constexpr std::string_view kStage = "bloom";
// The coarsest level is at least half this high and wide [pixel], so that a blur stays local.
constexpr uint kSmallestHalved = 16;
// Share that each wider blur has in the next finer one: weights fall by 0.7 an octave, chosen for a
// core with a wide, faint skirt.
constexpr float kScatter = 0.7f;

// Width, height and stride of a level [pixel].
cl_uint4 level_size(uint width, uint height) {
    return {{width, height, (width + 15u) / 16u * 16u, 0u}};
}

std::vector<cl_uint4> pyramid(const View& view) {
    std::vector<cl_uint4> sizes = {{{view.width, view.height, view.stride, 0u}}};
    while (std::min(sizes.back().s[0], sizes.back().s[1]) >= kSmallestHalved) {
        const cl_uint4 last = sizes.back();
        sizes.push_back(level_size((last.s[0] + 1) / 2, (last.s[1] + 1) / 2));
    }
    return sizes;
}

}  // namespace

Bloom::Bloom(const Gpu& gpu) : gpu_(gpu), program_(build_program(gpu, kStage)) {}

Radiance Bloom::enqueue(const Radiance& radiance, float share, StageTimer& timer) {
    return in_stage(kStage, [&] {
        const std::vector<cl_uint4> sizes = pyramid(radiance.view);
        if (share <= 0.0f || sizes.size() == 1) return radiance;
        while (levels_.size() < sizes.size()) levels_.emplace_back(gpu_, kStage);
        const auto items = [&](std::size_t i) {
            const auto lanes = static_cast<std::size_t>(gpu_.info.lane_width);
            return cl::EnqueueArgs(gpu_.queue,
                                   cl::NDRange(sizes[i].s[2] / lanes, sizes[i].s[1], 3));
        };
        for (std::size_t i = 0; i < sizes.size(); ++i) {
            levels_[i].reserve(std::size_t{3} * sizes[i].s[1] * sizes[i].s[2] * sizeof(float));
        }
        cl::KernelFunctor<cl::Buffer, cl_uint4, cl_uint4, cl::Buffer> down(program_, "bloom_down");
        for (std::size_t i = 1; i < sizes.size(); ++i) {
            const cl::Buffer& fine = i == 1 ? radiance.planes : levels_[i - 1].get();
            timer.record(kStage, down(items(i), fine, sizes[i - 1], sizes[i], levels_[i].get()));
        }
        cl::KernelFunctor<cl::Buffer, cl_uint4, cl::Buffer, cl_uint4, float, cl::Buffer> up(
            program_, "bloom_up");
        for (std::size_t i = sizes.size() - 1; i > 0; --i) {
            const cl::Buffer& fine = i == 1 ? radiance.planes : levels_[i - 1].get();
            timer.record(kStage, up(items(i - 1), levels_[i].get(), sizes[i], fine, sizes[i - 1],
                                    i == 1 ? share : kScatter, levels_[i - 1].get()));
        }
        return Radiance{levels_[0].get(), radiance.view};
    });
}

}  // namespace kilolux
