// SPDX-License-Identifier: Apache-2.0
#include "present/image/automatic_exposure.h"

#include <algorithm>
#include <cmath>

namespace kilolux {

float automatic_exposure(std::span<const float> radiance) {
    constexpr double kMiddleGrey = 0.18;
    constexpr double kMost = 126.0;  // [EV] that a float holds
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i + 2 < radiance.size(); i += 3) {
        const double luminance =
            0.2126 * radiance[i] + 0.7152 * radiance[i + 1] + 0.0722 * radiance[i + 2];
        if (!(luminance > 0.0) || !std::isfinite(luminance)) continue;
        sum += std::log2(luminance);
        ++count;
    }
    if (count == 0) return 0.0f;
    const double ev = std::log2(kMiddleGrey) - sum / static_cast<double>(count);
    return static_cast<float>(std::clamp(0.01 * std::round(100.0 * ev), -kMost, kMost));
}

}  // namespace kilolux
