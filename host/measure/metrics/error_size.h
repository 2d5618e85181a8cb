// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace kilolux {

/// Limits of the size of a comparison with a reference.
struct ErrorSizeLimits {
    int width = 320;           // [pixel]
    double evaluations = 3e8;  // of every light at every pixel: seconds of float64 on a small CPU
};

/// `resolution` scaled down to the limits, at least 1x1.
inline std::array<int, 2> error_size(std::array<int, 2> resolution, std::uint64_t lights,
                                     const ErrorSizeLimits& limits = {}) {
    const auto [width, height] = resolution;
    const double evaluations = static_cast<double>(width) * height *
                               static_cast<double>(std::max<std::uint64_t>(lights, 1));
    const double scale = std::min({1.0, static_cast<double>(limits.width) / width,
                                   std::sqrt(limits.evaluations / evaluations)});
    return {std::max(1, static_cast<int>(scale * width)),
            std::max(1, static_cast<int>(scale * height))};
}

}  // namespace kilolux
