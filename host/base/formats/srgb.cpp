// SPDX-License-Identifier: Apache-2.0
#include "host/base/formats/srgb.h"

#include <bit>
#include <cmath>
#include <limits>

#include "kernels/shared/tone_curve.h"

namespace kilolux {
namespace {

// Smallest float whose sRGB value rounds to `code` or more.
float first_float_of(std::uint32_t code) {
    const double linear = srgb_to_linear((code - 0.5) / 255.0);
    const auto nearest = static_cast<float>(linear);
    return static_cast<double>(nearest) >= linear
               ? nearest
               : std::nextafter(nearest, std::numeric_limits<float>::infinity());
}

}  // namespace

double srgb_to_linear(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double linear_to_srgb(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

std::array<double, 256> srgb_to_linear_table() {
    std::array<double, 256> table{};
    for (std::size_t code = 0; code < table.size(); ++code) {
        table[code] = srgb_to_linear(static_cast<double>(code) / 255.0);
    }
    return table;
}

SrgbBuckets srgb_buckets() {
    SrgbBuckets buckets;
    std::uint32_t code = 0;
    for (std::uint32_t bucket = 0; bucket < SRGB_BUCKETS; ++bucket) {
        const float low = std::bit_cast<float>(SRGB_FIRST_BITS + (bucket << SRGB_BUCKET_SHIFT));
        const float high =
            std::bit_cast<float>(SRGB_FIRST_BITS + ((bucket + 1) << SRGB_BUCKET_SHIFT));
        while (code < 255 && first_float_of(code + 1) <= low) ++code;
        const float next =
            code < 255 ? first_float_of(code + 1) : std::numeric_limits<float>::infinity();
        buckets.code.push_back(code);
        buckets.boundary.push_back(next < high ? next : std::numeric_limits<float>::infinity());
    }
    return buckets;
}

}  // namespace kilolux
