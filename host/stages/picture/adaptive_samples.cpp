// SPDX-License-Identifier: Apache-2.0
#include "host/stages/picture/adaptive_samples.h"

#include <algorithm>
#include <cassert>

namespace kilolux {
namespace {

std::size_t size_of(const View& view) { return std::size_t{view.stride} * view.height; }

}  // namespace

AdaptiveSamples::AdaptiveSamples(const Gpu& gpu, const Tuning& tuning)
    : gpu_(gpu),
      tuning_(tuning),
      program_(build_program(gpu, kAdaptiveSamplesStage)),
      add_(gpu, program_, kAdaptiveSamplesStage, "adaptive_samples_add"),
      decide_(gpu, program_, kAdaptiveSamplesStage, "adaptive_samples_decide"),
      mean_kernel_(gpu, program_, kAdaptiveSamplesStage, "adaptive_samples_mean"),
      fixed_(gpu, kAdaptiveSamplesStage),
      state_(gpu, kAdaptiveSamplesStage),
      mean_(gpu, kAdaptiveSamplesStage),
      variance_(gpu, kAdaptiveSamplesStage) {}

void AdaptiveSamples::add(uint half, const Radiance& radiance, StageTimer& timer) {
    if (taken_[0] == 0 && taken_[1] == 0) {
        view_ = radiance.view;
        groups_ = radiance.groups;
        const std::size_t size = std::size_t{2} * tile_count();
        upload<uint>(gpu_, fixed_.reserve(size), std::vector<uint>(size));
        state_.reserve(state_floats(groups_) * size_of(view_));
    }
    add_.enqueue(add_.pixel_items(view_, tuning_.shade_rows), timer, shape(), half, ++taken_[half],
                 radiance.planes, fixed_.get(), state_.get());
}

void AdaptiveSamples::decide(float error, float floor, StageTimer& timer) {
    assert(taken_[0] == taken_[1] && taken_[0] > 1);
    decide_.enqueue(items(tile_count(), 1), timer, shape(), taken_[0], error * error, floor * floor,
                    state_.get(), fixed_.get());
}

std::vector<bool> AdaptiveSamples::open_tiles() const {
    const std::vector<uint> fixed = download(gpu_, fixed_.get(), std::size_t{2} * tile_count());
    std::vector<bool> open;
    for (uint i = 0; i < tile_count(); ++i) {
        open.push_back(fixed[i] == 0 || fixed[tile_count() + i] == 0);
    }
    return open;
}

Radiance AdaptiveSamples::mean(StageTimer& timer) {
    Radiance out{mean_.reserve(shape().planes * size_of(view_)), view_, groups_};
    mean_kernel_.enqueue(mean_kernel_.pixel_items(view_, tuning_.shade_rows), timer, shape(),
                         taken_[0], state_.get(), fixed_.get(), out.planes,
                         variance_.reserve(size_of(view_)));
    return out;
}

std::vector<uint> AdaptiveSamples::taken() const {
    const std::vector<uint> fixed = download(gpu_, fixed_.get(), std::size_t{2} * tile_count());
    std::vector<uint> out(size_of(view_));
    for (uint y = 0; y < view_.height; ++y) {
        for (uint x = 0; x < view_.width; ++x) {
            const uint tile = fine_tile_of(view_, x, y);
            const auto [least, most] = std::minmax(fixed[tile], fixed[tile_count() + tile]);
            out[std::size_t{y} * view_.stride + x] = 2 * (least == 0 ? taken_[0] : most);
        }
    }
    return out;
}

}  // namespace kilolux
