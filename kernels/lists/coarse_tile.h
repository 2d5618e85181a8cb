// SPDX-License-Identifier: Apache-2.0
// Where a fine tile lies in the coarse grid.
#ifndef KILOLUX_DEVICE_COARSE_TILE_H
#define KILOLUX_DEVICE_COARSE_TILE_H
#include "kernels/shared/cluster_grid.h"
#include "kernels/shared/view.h"

typedef struct CoarseTile {
    uint column, row;
} CoarseTile;

static inline CoarseTile coarse_tile(View view, ClusterGrid grid, uint fine_tile) {
    uint tiles_x = fine_tiles_x(view);
    CoarseTile coarse;
    coarse.column = picture_column(view, fine_tile % tiles_x * FINE_TILE) / grid.tile_width;
    coarse.row = picture_row(view, fine_tile / tiles_x * FINE_TILE) / grid.tile_height;
    return coarse;
}

#endif
