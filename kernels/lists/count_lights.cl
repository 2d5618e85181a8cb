// SPDX-License-Identifier: Apache-2.0
// Counts per pixel the lights of its list (k), which shading evaluates, and those whose range
// covers it (k*). For statistics and views; no part of a frame otherwise.
// One work-item counts for VW neighbouring pixels of a row.
#include "kernels/device/lit_item.h"

static inline UV count_covering(FV3 p, global const float4* bounds, global const LIGHT_INDEX* list,
                                uint count) {
    UV covering = (UV)(0u);
    for (uint i = 0; i < count; ++i) {
        float4 light = bounds[list[i]];
        FV3 v = fv3(fv(light.x) - p.x, fv(light.y) - p.y, fv(light.z) - p.z);
        MASK inside = lane_mask(dot3(v, v) * light.w < fv(1.0f));
        covering -= lane_bits(inside);
    }
    return covering;
}

kernel void count_lights(LIT_ARGS,
                         global uint* restrict evaluated,   // out [height][stride]
                         global uint* restrict covering) {  // likewise; ~0 for background
    BEGIN_CLUSTERED_ROW;
    UV k = (UV)(~0u);
    UV k_star = (UV)(~0u);
    if (item.any) {
        FV3 p = load_position(g, item.pixels, item.z);
        FOR_EACH_CLUSTER_OF(item, i, mine, active, at.tile) {
            uint count = clusters[i].list_count;
            k = select(k, (UV)(count), lane_bits(mine));
            k_star =
                select(k_star, count_covering(p, bounds, lists + clusters[i].list_begin, count),
                       lane_bits(mine));
        }
    }
    lane_store(k, evaluated + item.pixels.first);
    lane_store(k_star, covering + item.pixels.first);
}
