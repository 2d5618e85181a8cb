// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/adaptive_scale.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kilolux {
namespace {

constexpr double kStep = 0.875;  // of the edges; pixels shrink by its square
// A picture below this share of the target leaves room for the next larger step.
constexpr double kRoom = kStep * kStep * 0.9;

}  // namespace

void AdaptiveScale::picture_took(double ms, double scale) {
    if (!(ms > 0.0) || !(scale > 0.0)) return;
    if (std::exchange(last_scale_, scale) == scale) choose(ms, scale, 6.0);
}

void AdaptiveScale::picture_would_take(double ms, double scale) {
    if (ms > target_ms_ && scale > 0.0) choose(ms, scale, 1e3);
}

void AdaptiveScale::choose(double ms, double scale, double most_steps) {
    const double share = ms / target_ms_;
    double next = scale;
    if (share > 1.0) {
        // Assumes that time is proportional to the pixels. Later pictures correct the rest.
        const double steps = std::ceil(0.5 * std::log(share) / -std::log(kStep));
        next = scale * std::pow(kStep, std::clamp(steps, 1.0, most_steps));
    } else if (share < kRoom) {
        next = share < 0.4 ? scale / (kStep * kStep) : scale / kStep;
    }
    moving_scale_ = std::clamp(next, kLeast, 1.0);
}

}  // namespace kilolux
