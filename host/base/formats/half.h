// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace kilolux {

/// The largest finite IEEE binary16.
inline constexpr double kHalfMax = 65504.0;

/// IEEE binary16 of a value, rounded to nearest even; what is beyond +-65504, infinite too, becomes
/// +-65504: a picture's brightest pixel must not turn into Inf, which filters spread. NaN stays
/// NaN.
inline std::uint16_t half_bits_clamped(double value) {
    const unsigned sign = std::signbit(value) ? 0x8000u : 0u;
    if (std::isnan(value)) return static_cast<std::uint16_t>(sign | 0x7e00u);
    const double magnitude = std::min(std::abs(value), kHalfMax);
    if (magnitude < 0x1p-25) return static_cast<std::uint16_t>(sign);
    const int exponent = std::max(std::ilogb(magnitude), -14);
    // In units of the last place; 2048 carries into the exponent by itself.
    const auto steps = static_cast<unsigned>(std::nearbyint(std::ldexp(magnitude, 10 - exponent)));
    const auto exponent_bits = static_cast<unsigned>(exponent + 14) << 10;
    return static_cast<std::uint16_t>(sign + exponent_bits + steps);
}

/// The value of an IEEE binary16.
inline double half_value(std::uint16_t bits) {
    const int exponent = bits >> 10 & 31;
    const int mantissa = bits & 1023;
    const double sign = (bits & 0x8000) != 0 ? -1.0 : 1.0;
    if (exponent == 31) {
        return mantissa == 0 ? sign * std::numeric_limits<double>::infinity()
                             : std::numeric_limits<double>::quiet_NaN();
    }
    const int scaled = exponent == 0 ? mantissa : 1024 + mantissa;
    return sign * std::ldexp(scaled, std::max(exponent, 1) - 25);
}

}  // namespace kilolux
