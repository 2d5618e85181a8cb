// SPDX-License-Identifier: Apache-2.0
// bin_pixels by one work-item a tile: slice after slice, all its strips. For CPUs.
#include "kernels/lists/bin_pixels.h"

// Slices of a tile's pixels.
typedef struct TileSlices {
    UV slice[FINE_TILE * STRIPS];
    FV z[FINE_TILE * STRIPS];  // depths [m], where there is a slice
    uint first, last;          // smallest and largest; first = NO_SLICE if there is none
} TileSlices;

static inline void load_slices(GBuffer g, ClusterGrid grid, uint tile_x, uint tile_y,
                               TileSlices* out) {
    UV first = (UV)(NO_SLICE);
    UV last = (UV)(0u);
    uint strips = rows_of_tile(g.view, tile_y) * STRIPS;
    for (uint i = 0; i < FINE_TILE * STRIPS; ++i) {
        UV slice = (UV)(NO_SLICE);
        if (i < strips)
            slice = slices_of_pixels(g, grid, strip_pixels(g.view, tile_x, tile_y, i), &out->z[i]);
        out->slice[i] = slice;
        first = min(first, slice);
        // NO_SLICE + 1 wraps to 0.
        last = max(last, slice + 1u);
    }
    out->first = lane_min_uint(first);
    out->last = ~lane_min_uint(~last) - 1u;
}

// The smallest slice of the tile above `slice`, or NO_SLICE.
static inline uint next_slice(const TileSlices* tile, uint slice) {
    if (slice >= tile->last) return NO_SLICE;
    UV next = (UV)(NO_SLICE);
    for (uint i = 0; i < FINE_TILE * STRIPS; ++i) {
        MASK above = tile->slice[i] > (UV)(slice);
        next = min(next, select((UV)(NO_SLICE), tile->slice[i], lane_mask(above)));
    }
    return lane_min_uint(next);
}

kernel void bin_pixels_count(GBUFFER_ARGS, ClusterGrid grid,
                             global uint* restrict counts,  // out [tiles]: active clusters
                             // Of coarse clusters: 1 where one has active ones. In: 0; concurrent
                             // writers write the same value.
                             global uchar* restrict occupied) {  // [cluster_count]
    uint tiles_x = fine_tiles_x(view);
    uint tile = get_global_id(0);
    GBuffer g = GBUFFER_OF_ARGS;
    TileSlices slices;
    load_slices(g, grid, tile % tiles_x, tile / tiles_x, &slices);
    CoarseTile coarse = coarse_tile(view, grid, tile);
    uint count = 0;
    for (uint slice = slices.first; slice != NO_SLICE; slice = next_slice(&slices, slice)) {
        ++count;
        occupied[cluster_index(grid, coarse.column, coarse.row, slice >> grid.fine_slice_bits)] = 1;
    }
    counts[tile] = count;
}

// Box and count of the tile's pixels in one slice.
static inline ActiveCluster cluster_of_slice(GBuffer g, uint tile_x, uint tile_y,
                                             const TileSlices* tile, uint slice) {
    FV3 lo = fv3(fv(Z_UNBOUNDED), fv(Z_UNBOUNDED), fv(Z_UNBOUNDED));
    FV3 hi = fv3(fv(-Z_UNBOUNDED), fv(-Z_UNBOUNDED), fv(-Z_UNBOUNDED));
    UV pixels = (UV)(0u);
    for (uint i = 0; i < FINE_TILE * STRIPS; ++i) {
        MASK mask = lane_mask(tile->slice[i] == (UV)(slice));
        if (!lane_any(mask)) continue;
        Pixels at = strip_pixels(g.view, tile_x, tile_y, i);
        FV3 p = load_position(g, at, tile->z[i]);
        lo = fv3(min(lo.x, lane_select(mask, p.x, lo.x)), min(lo.y, lane_select(mask, p.y, lo.y)),
                 min(lo.z, lane_select(mask, p.z, lo.z)));
        hi = fv3(max(hi.x, lane_select(mask, p.x, hi.x)), max(hi.y, lane_select(mask, p.y, hi.y)),
                 max(hi.z, lane_select(mask, p.z, hi.z)));
        pixels -= lane_bits(mask);
    }
    ActiveCluster c;
    c.min_x = lane_min(lo.x);
    c.min_y = lane_min(lo.y);
    c.min_z = lane_min(lo.z);
    c.max_x = lane_max(hi.x);
    c.max_y = lane_max(hi.y);
    c.max_z = lane_max(hi.z);
    c.slice = slice;
    c.pixel_count = lane_sum(pixels);
    c.list_begin = 0;
    c.list_count = 0;
    c.first_pixel = 0;
    c.first_word = 0;
    return c;
}

// Appends the pixels of one slice (row * FINE_TILE + column) to the tile's order, which has room
// for one more than there are; returns the new count. A branch could not be predicted, so each
// pixel is written, and the next one overwrites it if it is of another slice.
static inline uint append_pixels(const TileSlices* tile, uint slice, uint strips, uchar* order,
                                 uint count) {
    for (uint i = 0; i < strips; ++i) {
        MASK mine = lane_mask(tile->slice[i] == (UV)(slice));
        if (!lane_any(mine)) continue;
        uint flag[VW];
        lane_store(lane_bits(mine) & 1u, flag);
#pragma unroll
        for (uint lane = 0; lane < VW; ++lane) {
            order[count] = (uchar)(i * VW + lane);
            count += flag[lane];
        }
    }
    return count;
}

kernel void bin_pixels_fill(GBUFFER_ARGS, CLUSTER_ARGS()) {  // out: clusters and order
    uint tiles_x = fine_tiles_x(view);
    uint tile = get_global_id(0);
    uint tile_y = tile / tiles_x;
    uint place = cluster_offsets[tile];
    if (place == cluster_offsets[tile + 1]) return;
    GBuffer g = GBUFFER_OF_ARGS;
    TileSlices slices;
    load_slices(g, grid, tile % tiles_x, tile_y, &slices);
    uint strips = rows_of_tile(view, tile_y) * STRIPS;
    uchar tile_order[FINE_TILE_PIXELS + 1];
    uint ordered = 0;
    for (uint slice = slices.first; slice != NO_SLICE; slice = next_slice(&slices, slice)) {
        if (place < cluster_capacity)
            clusters[place] = cluster_of_slice(g, tile % tiles_x, tile_y, &slices, slice);
        ordered = append_pixels(&slices, slice, strips, tile_order, ordered);
        ++place;
    }
    ordered = append_pixels(&slices, NO_SLICE, strips, tile_order, ordered);
    for (uint i = 0; i < ordered; ++i) order[tile * FINE_TILE_PIXELS + i] = tile_order[i];
}
