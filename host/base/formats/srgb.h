// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace kilolux {

/// Linear value in [0, 1] of an sRGB value in [0, 1], and back. IEC 61966-2-1.
double srgb_to_linear(double encoded);
double linear_to_srgb(double linear);

/// Light as tone curves take it, as in kernels/picture/tonemap.cl: NaN and negative values are
/// black, 1e9 is the largest.
inline float displayable(double light) {
    return light > 0.0 ? static_cast<float>(light < 1e9 ? light : 1e9) : 0.0f;
}

/// Linear value of each 8-bit sRGB code.
std::array<double, 256> srgb_to_linear_table();

/// Tables by which tonemap.cl rounds linear light to the nearest sRGB code; see
/// kernels/shared/tone_curve.h.
struct SrgbBuckets {
    std::vector<float>
        boundary;  // [SRGB_BUCKETS] smallest float of the next code; infinity if not in the bucket
    std::vector<std::uint32_t> code;  // [SRGB_BUCKETS] code at the bucket's lower end
};
SrgbBuckets srgb_buckets();

}  // namespace kilolux
