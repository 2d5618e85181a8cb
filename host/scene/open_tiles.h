// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace kilolux {

/// The square tiles of a picture, of which only some are needed.
struct OpenTiles {
    int size = 1;            // [pixel]
    int columns = 0;         // of tiles
    int first_row = 0;       // of the picture, where the tiles begin [pixel]
    std::vector<bool> open;  // row by row

    /// Whether a rectangle of pixels touches one that is needed.
    bool touches(const glm::dvec2& least, const glm::dvec2& most) const;
};

}  // namespace kilolux
