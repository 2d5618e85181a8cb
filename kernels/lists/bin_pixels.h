// SPDX-License-Identifier: Apache-2.0
// The common part of both forms of bin_pixels.
//
// Active clusters: for every fine tile, one for each depth slice that occurs among its pixels, with
// the box of just those pixels (Olsson, Billeter, Assarsson 2012: explicit bounds). Background
// pixels belong to none, and tiles of background only cost nothing afterwards.
//   bin_pixels_clear  no coarse cluster is occupied
//   bin_pixels_count  active clusters of each tile, and where in the coarse grid there are any
//   (prefix_sum over tiles)
//   bin_pixels_fill   the clusters, and each tile's pixels in the order of its clusters
// In that order a vector of neighbours lies in one cluster, except for a few at the clusters' ends:
// shading sums one list a vector. In the order of rows it would sum the list of each cluster that
// the row crosses.
#ifndef KILOLUX_DEVICE_BIN_PIXELS_H
#define KILOLUX_DEVICE_BIN_PIXELS_H
#include "kernels/device/lit_item.h"
#include "kernels/lists/coarse_tile.h"

// A strip: VW pixels of a row of the tile.
#define STRIPS (FINE_TILE / VW)
// The slice of background pixels and of pixels beyond the image.
#define NO_SLICE 0xffffffffu

// Slices of pixels, and their depths `z` [m], undefined where there is no slice.
static inline UV slices_of_pixels(GBuffer g, ClusterGrid grid, Pixels pixels, FV* z) {
    LitItem item = clustered_item(g, grid, pixels);
    *z = item.z;
    return select((UV)(NO_SLICE), item.slice, item.shown);
}

static inline Pixels strip_pixels(View view, uint tile_x, uint tile_y, uint strip) {
    return row_pixels(view, tile_x * FINE_TILE + strip % STRIPS * VW,
                      tile_y * FINE_TILE + strip / STRIPS);
}

kernel void bin_pixels_clear(uint cluster_count,
                             global uchar* restrict occupied) {  // out [cluster_count]
    uint cluster = get_global_id(0);
    if (cluster < cluster_count) occupied[cluster] = 0;
}
#endif
