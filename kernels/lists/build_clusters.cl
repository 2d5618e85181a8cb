// SPDX-License-Identifier: Apache-2.0
// Boxes of the coarse clusters in view space. A box is a product of three intervals, and x depends
// only on (tile column, slice), y on (tile row, slice), z on the slice: so only those are stored.
// Work-item (i, slice) writes column i's and row i's interval of the slice.
#include "kernels/device/arguments.h"

// Depths [m] of a slice's two ends; the outermost slices take what lies beyond the grid.
static inline float2 slice_depths(ClusterGrid grid, uint slice, bool orthographic) {
    float near = slice == 0 ? (orthographic ? -Z_UNBOUNDED : 0.0f) : depth_of_slice(grid, slice);
    float far = slice + 1 == grid.slices ? Z_UNBOUNDED : depth_of_slice(grid, slice + 1);
    return (float2)(near, far);
}

static inline float2 padded(float2 interval, float pad) {
    return (float2)(interval.x - pad, interval.y + pad);
}

// View-space interval [m] that pixel coordinates [p0, p1] span over the depths, along one axis with
// x_view = (p * step + offset) * z (perspective). 4e-7 covers the rounding of that formula for a
// pixel inside.
static inline float2 view_interval(float p0, float p1, float step, float offset, float2 depths,
                                   bool orthographic) {
    float pad = 4e-7f * (fabs(offset) + fabs(p1 * step));
    float a = fma(p0, step, offset);
    float b = fma(p1, step, offset);
    float lo = min(a, b) - pad;
    float hi = max(a, b) + pad;
    if (orthographic) return (float2)(lo, hi);
    return (float2)(min(lo * depths.x, lo * depths.y), max(hi * depths.x, hi * depths.y));
}

kernel void build_clusters(
    View view, BOX_ARGS()) {  // out [m]: x by column, y by row, z by slice, positive forward
    uint i = get_global_id(0);
    uint slice = get_global_id(1);
    bool orthographic = view.orthographic != 0u;
    float2 z = slice_depths(grid, slice, orthographic);
    if (i < grid.tiles_x) {
        float p = (float)(i * grid.tile_width);
        columns[slice * grid.tiles_x + i] = padded(
            view_interval(p, p + (float)grid.tile_width, view.ray.x, view.ray.y, z, orthographic),
            grid.position_pad);
    }
    if (i < grid.tiles_y) {
        float p = (float)(i * grid.tile_height);
        rows[slice * grid.tiles_y + i] = padded(
            view_interval(p, p + (float)grid.tile_height, view.ray.z, view.ray.w, z, orthographic),
            grid.position_pad);
    }
    if (i == 0) depths[slice] = padded(z, grid.position_pad);
}
