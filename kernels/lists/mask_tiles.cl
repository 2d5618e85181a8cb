// SPDX-License-Identifier: Apache-2.0
// Empties the fine tiles that need no more samples, since background is neither listed nor shaded.
// One work-item takes VW neighbouring pixels of a row.
#include "kernels/device/pixels.h"

kernel void mask_tiles(View view,
                       global const uint* restrict fixed,  // [2][tiles], see adaptive_samples.cl
                       global const uint* restrict ids,    // [height][stride]; 0 for background
                       global uint* restrict masked) {     // out, likewise
    ItemPlace at = place_in_planes(view);
    if (!at.inside || at.x >= view.width) return;
    bool is_done = fixed[at.tile] != 0 && fixed[fine_tile_count(view) + at.tile] != 0;
    uint pixel = at.y * view.stride + at.x;
    lane_store(is_done ? (UV)(0u) : lane_load(ids + pixel), masked + pixel);
}
