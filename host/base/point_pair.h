// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/shared/types.h"

namespace kilolux {

/// A point of the world as a pair of floats: the rounded position, and what rounding lost [m].
struct PointPair {
    float4 high{}, low{};
};

inline PointPair point_pair(double x, double y, double z) {
    const auto high = [](double v) { return static_cast<float>(v); };
    const auto low = [](double v) { return static_cast<float>(v - static_cast<float>(v)); };
    return {{high(x), high(y), high(z), 0.0f}, {low(x), low(y), low(z), 0.0f}};
}

}  // namespace kilolux
