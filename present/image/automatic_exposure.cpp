// SPDX-License-Identifier: Apache-2.0
#include "present/image/automatic_exposure.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace kilolux {

float automatic_exposure(std::span<const float> radiance) {
    constexpr double kMiddleGrey = 0.18;
    constexpr double kDisplayWhite = 1.0;
    constexpr double kClippedShare = 0.02;  // of the lit pixels, at most
    constexpr double kMost = 126.0;         // [EV] that a float holds
    double sum = 0.0;
    std::vector<float> brightest;  // channel of each lit pixel
    for (std::size_t i = 0; i + 2 < radiance.size(); i += 3) {
        const double luminance =
            0.2126 * radiance[i] + 0.7152 * radiance[i + 1] + 0.0722 * radiance[i + 2];
        if (!(luminance > 0.0) || !std::isfinite(luminance)) continue;
        sum += std::log2(luminance);
        brightest.push_back(std::max({radiance[i], radiance[i + 1], radiance[i + 2]}));
    }
    if (brightest.empty()) return 0.0f;
    const auto count = static_cast<double>(brightest.size());
    const auto at = static_cast<std::ptrdiff_t>(std::ceil((1.0 - kClippedShare) * count)) - 1;
    std::nth_element(brightest.begin(), brightest.begin() + at, brightest.end());
    const double highlight = brightest[static_cast<std::size_t>(at)];
    const double mean_ev = std::round(100.0 * (std::log2(kMiddleGrey) - sum / count));
    const double most_ev = std::floor(100.0 * std::log2(kDisplayWhite / highlight));
    return static_cast<float>(std::clamp(0.01 * std::min(mean_ev, most_ev), -kMost, kMost));
}

}  // namespace kilolux
