// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace kilolux {

/// One channel of a picture, row 0 on top.
struct Plane {
    int width = 0;   // [pixel]
    int height = 0;  // [pixel]
    std::vector<double> values;
    std::span<double> row(int y) {
        return std::span(values).subspan(
            static_cast<std::size_t>(y) * static_cast<std::size_t>(width),
            static_cast<std::size_t>(width));
    }
    std::span<const double> row(int y) const {
        return std::span(values).subspan(
            static_cast<std::size_t>(y) * static_cast<std::size_t>(width),
            static_cast<std::size_t>(width));
    }
};

Plane make_plane(int width, int height);

/// exp(-x^2 / (2 sigma^2)) at x = -radius..radius [pixel], not normalised.
std::vector<double> gaussian_taps(double sigma, int radius);

/// Scales `taps` so that they sum to 1.
std::vector<double> normalized(std::vector<double> taps);

/// sum_ij horizontal[i] * vertical[j] * in(x + i - rx, y + j - ry), both of odd length; pixels
/// beyond the border repeat the border's. Runs on all cores.
Plane filter_separable(const Plane& in, std::span<const double> horizontal,
                       std::span<const double> vertical);

}  // namespace kilolux
