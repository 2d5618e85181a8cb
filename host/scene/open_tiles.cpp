// SPDX-License-Identifier: Apache-2.0
#include "host/scene/open_tiles.h"

#include <algorithm>
#include <cmath>

namespace kilolux {

bool OpenTiles::touches(const glm::dvec2& least, const glm::dvec2& most) const {
    const int rows = static_cast<int>(open.size()) / columns;
    // Clamped before the conversion: the numbers may be beyond int's.
    const auto tile = [this](double pixel, int count) {
        return static_cast<int>(std::clamp(std::floor(pixel / size), -1.0, double(count)));
    };
    const int x0 = std::max(tile(least.x, columns), 0);
    const int x1 = std::min(tile(most.x, columns), columns - 1);
    const int y0 = std::max(tile(least.y - first_row, rows), 0);
    const int y1 = std::min(tile(most.y - first_row, rows), rows - 1);
    for (int y = y0; y <= y1; ++y) {
        for (int x = x0; x <= x1; ++x) {
            if (open[static_cast<std::size_t>(y * columns + x)]) return true;
        }
    }
    return false;
}

}  // namespace kilolux
