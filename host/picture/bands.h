// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/scene/camera.h"

namespace kilolux {

/// Neighbouring rows of a picture that are made at once.
struct Band {
    int first_row = 0;
    int rows = 0;
    bool operator==(const Band&) const = default;
};

/// OpenGL draws a picture in tiles of this many rows, whatever memory there is: where a triangle's
/// edge falls and what is interpolated depends on the target's origin in the last bit, so the same
/// tiles make the same bits. Bands of any height lie within them.
constexpr int kRasterRows = 4096;

/// Bands of at most `rows` rows, a multiple of FINE_TILE, from the top; none crosses a raster
/// tile's edge. A picture that fits is one band.
std::vector<Band> make_bands(int height, int rows);

/// The same for the rows `within` a picture.
std::vector<Band> make_bands(int height, int rows, Band within);

/// The raster tile that a row lies in.
Band raster_tile(int height, int row);

/// The camera that sees just these rows of a picture of `height` rows.
Camera crop(const Camera& camera, int height, Band rows);

/// The picture's View with the band's rows in its planes.
View view_of(const Camera& camera, int width, int height, Band band);

}  // namespace kilolux
