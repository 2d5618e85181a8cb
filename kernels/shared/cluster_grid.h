// SPDX-License-Identifier: Apache-2.0
// The coarse cluster grid: screen tiles x depth slices.
#ifndef KILOLUX_SHARED_CLUSTER_GRID_H
#define KILOLUX_SHARED_CLUSTER_GRID_H
#include "kernels/shared/types.h"
#include "kernels/shared/view.h"
#if defined(__cplusplus)
namespace kilolux {
#endif

// A fine tile: an active cluster covers one on the screen, and a work-group shades one [pixel].
#define FINE_TILE 16
#define FINE_TILE_PIXELS (FINE_TILE * FINE_TILE)

// Fine tiles of a row of the picture.
SHARED_FN uint fine_tiles_x(View view) { return (view.width + FINE_TILE - 1) / FINE_TILE; }

SHARED_FN uint fine_tile_count(View view) {
    return fine_tiles_x(view) * ((view.height + FINE_TILE - 1) / FINE_TILE);
}

// Number of the fine tile that holds pixel (x, y) of the planes.
SHARED_FN uint fine_tile_of(View view, uint x, uint y) {
    return y / FINE_TILE * fine_tiles_x(view) + x / FINE_TILE;
}

// cluster = (slice * tiles_y + tile_y) * tiles_x + tile_x. Tile edges are multiples of FINE_TILE,
// so every fine tile lies in one coarse tile.
SHARED_STRUCT(ClusterGrid) {
    uint tiles_x, tiles_y, slices;
    uint slices_per_octave;  // 1 .. 64: see slice_of_depth
    uint tile_width;         // [pixel]
    uint tile_height;        // [pixel]
    uint z_first_bits;       // bits of z_first [m], the near end of slice 0
    uint cluster_count;
    float position_pad;    // [m] how far a stored position may lie from its pixel's ray and depth
    uint fine_slice_bits;  // a coarse slice holds 2^this slices of the active clusters
    uint unused0, unused1;
};
SHARED_ASSERT(cluster_grid_size, sizeof(ClusterGrid) == 48);

// Steps of a float from one depth to its double.
#define OCTAVE_BITS 23
#define OCTAVE_MASK ((1u << OCTAVE_BITS) - 1u)

// Slice of a depth z [m]. The bits of a positive float are a piecewise linear log2 of it, exactly
// monotone and the same on every device: slice = steps from z_first * slices_per_octave / 2^23,
// rounded down. The octave and the rest are multiplied apart, so that 32 bits hold the product.
// Depths nearer than z_first (or negative) fall into slice 0, those beyond the last slice into the
// last: no pixel is lost. NaN, for which max() is undefined, falls into either.
SHARED_FN UV slice_of_depth(ClusterGrid grid, FV z) {
    FV clamped = max(z, fv(bits_float(grid.z_first_bits)));
    UV steps = lane_bits(clamped) - grid.z_first_bits;
    UV within = ((steps & OCTAVE_MASK) * grid.slices_per_octave) >> OCTAVE_BITS;
    UV slice = (steps >> OCTAVE_BITS) * grid.slices_per_octave + within;
    return min(slice, lane_uint(grid.slices - 1u));
}

// The same for the finer slices of active clusters; a coarse slice is fine >> grid.fine_slice_bits.
SHARED_FN UV fine_slice_of_depth(ClusterGrid grid, FV z) {
    grid.slices_per_octave <<= grid.fine_slice_bits;
    grid.slices <<= grid.fine_slice_bits;
    return slice_of_depth(grid, z);
}

// The nearest depth [m] of a slice. Slice 0 also holds nearer depths.
SHARED_FN float depth_of_slice(ClusterGrid grid, uint slice) {
    uint octave = slice / grid.slices_per_octave;
    uint part = (slice - octave * grid.slices_per_octave) << OCTAVE_BITS;
    uint within = (part + grid.slices_per_octave - 1u) / grid.slices_per_octave;
    return bits_float(grid.z_first_bits + (octave << OCTAVE_BITS) + within);
}

SHARED_FN uint cluster_index(ClusterGrid grid, uint tile_x, uint tile_y, uint slice) {
    return (slice * grid.tiles_y + tile_y) * grid.tiles_x + tile_x;
}

// The tolerance of a list test beyond the range, relative to range^2: more than float32's rounding
// of distance^2 / range^2 (8 u = 5e-7), so that no light within its range by exact arithmetic is
// missing.
#define CULL_LIMIT 1.000002f

// Farther than any scene [m]: the far end of the last slice.
#define Z_UNBOUNDED 1e30f

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
