// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace kilolux {

using SrgbCode = std::array<std::uint8_t, 3>;

/// Viridis at t in [0, 1], clamped: dark blue over green to yellow, even steps of lightness, fit
/// for the colour blind. Smith and van der Walt 2015 (CC0), as a polynomial of degree 6 within 3
/// codes.
SrgbCode viridis(double t);

/// Which magnitudes get the ends of the map.
struct FalseColorScale {
    double low = 0.0;
    double high = 1.0;         // > low
    bool logarithmic = false;  // then low > 0; equal ratios are equal steps
};

/// Where a magnitude falls on the scale, 0..1, clamped. NaN stays NaN.
double scale_position(double magnitude, const FalseColorScale& scale);

/// A picture of error magnitudes: sRGB codes, 4 a value, opaque. NaN is magenta, which the map has
/// not.
std::vector<std::uint8_t> false_color(std::span<const double> magnitudes,
                                      const FalseColorScale& scale);

}  // namespace kilolux
