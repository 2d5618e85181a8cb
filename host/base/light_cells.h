// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/shared/lights/light_order.h"

namespace kilolux {

/// Edge of the cells by which lights of this range are ordered [m]: a power of two, more than half
/// the range, at most the range. Smaller cells would hardly tighten what a run of lights reaches,
/// and the curve, which repeats after 2048 cells, would repeat within a scene. Its inverse is a
/// float.
inline double light_cell_edge(float range) {
    return std::ldexp(1.0, std::clamp(std::ilogb(range), -120, 120));
}

/// The number of the cell that x [m] lies in along an axis.
inline uint light_cell(double x, double edge) {
    const double cell = x / edge;
    if (!(std::abs(cell) < LIGHT_CELLS)) return LIGHT_CELL_FAR;
    return static_cast<uint>(static_cast<int>(std::floor(cell)));
}

}  // namespace kilolux
