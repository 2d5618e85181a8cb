// SPDX-License-Identifier: Apache-2.0
#include "host/picture/bands.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "kernels/shared/cluster_grid.h"

namespace kilolux {

std::vector<Band> make_bands(int height, int rows) { return make_bands(height, rows, {0, height}); }

std::vector<Band> make_bands(int height, int rows, Band within) {
    assert(rows > 0 && rows % FINE_TILE == 0);
    std::vector<Band> bands;
    const int end = within.first_row + within.rows;
    for (int row = within.first_row; row < end; row += bands.back().rows) {
        const Band tile = raster_tile(height, row);
        bands.push_back({row, std::min({rows, tile.first_row + tile.rows - row, end - row})});
    }
    return bands;
}

Band raster_tile(int height, int row) {
    const int first = row / kRasterRows * kRasterRows;
    return {first, std::min(kRasterRows, height - first)};
}

Camera crop(const Camera& camera, int height, Band rows) {
    if (rows == Band{0, height}) return camera;
    const double share = static_cast<double>(rows.rows) / height;
    // The rows' middle in the picture's normalised coordinates, +1 at the top.
    const double middle = 1.0 - (2.0 * rows.first_row + rows.rows) / height;
    Camera out = camera;
    out.y_fov = 2.0 * std::atan(std::tan(0.5 * camera.y_fov) * share);
    out.y_extent = camera.y_extent * share;
    out.shear.y = (camera.shear.y - middle) / share;
    return out;
}

View view_of(const Camera& camera, int width, int height, Band band) {
    View view = view_of(camera, width, height);
    view.first_row = static_cast<uint>(band.first_row);
    view.height = static_cast<uint>(band.rows);
    return view;
}

}  // namespace kilolux
