// SPDX-License-Identifier: Apache-2.0
// Empties the fine tiles that need no more samples, since background is neither listed nor shaded.
// One work-item takes VW neighbouring pixels of a row.
#include "kernels/device/lanes.h"
#include "kernels/shared/cluster_grid.h"

kernel void mask_tiles(View view,
                       global const uint* restrict fixed,  // [2][tiles], see adaptive_samples.cl
                       global const uint* restrict ids,    // [height][stride]; 0 for background
                       global uint* restrict masked) {     // out, likewise
    uint x = (uint)get_global_id(0) * VW;
    uint y = get_global_id(1);
    if (y >= view.height || x >= view.width) return;
    uint tile = fine_tile_of(view, x, y);
    bool is_done = fixed[tile] != 0 && fixed[fine_tile_count(view) + tile] != 0;
    uint pixel = y * view.stride + x;
    lane_store(is_done ? (UV)(0u) : lane_load(ids + pixel), masked + pixel);
}
