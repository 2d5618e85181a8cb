// SPDX-License-Identifier: Apache-2.0
// What shading evaluates and what it needs: per pixel, the lights of its list (k), and those whose
// range covers it (k*). For statistics and views; no part of a frame otherwise.
// One work-item counts for VW neighbouring pixels of a row.
#include "kernels/device/gbuffer.h"
#include "kernels/device/light_index.h"
#include "kernels/shared/cluster_grid.h"
#include "kernels/shared/clusters.h"

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

kernel void count_lights(
    global const uchar* restrict gbuffer, GBufferLayout layout, View view,
    global const float4* restrict bounds,  // [light_count]
    ClusterGrid grid,
    global const uint* restrict cluster_offsets,    // [tiles + 1]
    global const ActiveCluster* restrict clusters,  // [cluster_capacity]
    uint cluster_capacity, global const LIGHT_INDEX* restrict lists,
    global uint* restrict evaluated,   // out [height][stride]; ~0 for background
    global uint* restrict covering) {  // out [height][stride]; ~0 for background
    uint x = (uint)get_global_id(0) * VW;
    uint y = get_global_id(1);
    if (y >= view.height) return;
    GBuffer g = {gbuffer, layout, view, 0};
    Pixels pixels = row_pixels(view, x, y);
    FV depth01 = load_depth01(g, pixels);
    MASK drawn = lane_mask(depth01 > fv(0.0f)) & within_width(view, pixels);
    UV k = (UV)(~0u);
    UV k_star = (UV)(~0u);
    if (lane_any(drawn)) {
        FV z = view_depth(view, pixels.x, pixels.y, lane_select(drawn, depth01, fv(1.0f)));
        FV3 p = load_position(g, pixels, z);
        UV slice = fine_slice_of_depth(grid, z);
        uint tile = fine_tile_of(view, x, y);
        uint end = min(cluster_offsets[tile + 1], cluster_capacity);
        for (uint i = cluster_offsets[tile]; i < end; ++i) {
            MASK mine = lane_mask(slice == (UV)(clusters[i].slice)) & drawn;
            if (!lane_any(mine)) continue;
            uint count = clusters[i].list_count;
            k = select(k, (UV)(count), lane_bits(mine));
            k_star =
                select(k_star, count_covering(p, bounds, lists + clusters[i].list_begin, count),
                       lane_bits(mine));
        }
    }
    lane_store(k, evaluated + pixels.first);
    lane_store(k_star, covering + pixels.first);
}
