// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/shared/types.h"

namespace kilolux {

/// What rounding v to a float loses, rounded.
float lost_by_rounding(double v);

/// A point of the world as a pair of floats: the rounded position, and what rounding lost [m].
struct PointPair {
    float4 high{}, low{};
};
PointPair point_pair(double x, double y, double z);

}  // namespace kilolux
