// SPDX-License-Identifier: Apache-2.0
// Per pixel the lights, directional ones too, that it faces within their range, and those of them
// that it sees past what casts shadows. For views; no part of a frame otherwise.
// One work-item counts for VW pixels, neighbours in the order of their tile's clusters.
#define ORDERED_PIXELS 1
#include "kernels/device/gbuffer.h"
#include "kernels/device/light_index.h"
#include "kernels/shadows/shadow_bits.h"
#include "kernels/shared/cluster_grid.h"
#include "kernels/shared/clusters.h"

typedef struct SeenLights {
    UV facing, seen;
} SeenLights;

static inline SeenLights add_seen(SeenLights sum, MASK facing, MASK sees) {
    sum.facing -= lane_bits(facing);
    sum.seen -= lane_bits(facing & sees);
    return sum;
}

static inline SeenLights count_directional(FV3 n, global const DirectionalLight* lights, uint count,
                                           ShadowBits bits) {
    SeenLights sum = {(UV)(0u), (UV)(0u)};
    for (uint i = 0; i < count; ++i) {
        float4 l = lights[i].to_light;
        FV cosine = dot3(n, fv3(fv(l.x), fv(l.y), fv(l.z)));
        sum = add_seen(sum, lane_mask(cosine > fv(0.0f)), sees_light(bits, i));
    }
    return sum;
}

// `first`: place of the list's first light among the cluster's.
static inline SeenLights count_list(SeenLights sum, FV3 p, FV3 n, global const float4* bounds,
                                    global const LIGHT_INDEX* list, uint count, ShadowBits bits,
                                    uint first) {
    for (uint i = 0; i < count; ++i) {
        float4 light = bounds[list[i]];
        FV3 v = fv3(fv(light.x) - p.x, fv(light.y) - p.y, fv(light.z) - p.z);
        MASK facing = lane_mask(dot3(v, v) * light.w < fv(1.0f)) & lane_mask(dot3(n, v) > fv(0.0f));
        sum = add_seen(sum, facing, sees_light(bits, first + i));
    }
    return sum;
}

kernel void count_seen(global const uchar* restrict gbuffer, GBufferLayout layout, View view,
                       global const DirectionalLight* restrict directional, uint directional_count,
                       global const float4* restrict bounds,  // [light_count]
                       ClusterGrid grid,
                       global const uint* restrict cluster_offsets,    // [tiles + 1]
                       global const ActiveCluster* restrict clusters,  // [cluster_capacity]
                       uint cluster_capacity,
                       global const uchar* restrict order,  // [tiles][FINE_TILE_PIXELS]
                       global const LIGHT_INDEX* restrict lists,
                       global const uint* restrict shadow_offsets,         // [tiles + 1]
                       global const uint* restrict shadow_words_of_tiles,  // cast_shadows'
                       global uint* restrict facing,  // out [height][stride]; background is left
                       global uint* restrict seen) {  // out, likewise
    uint x = (uint)get_global_id(0) * VW;
    uint y = get_global_id(1);
    if (y >= view.height) return;
    uint tile = fine_tile_of(view, x, y);
    uint place = place_of_item(x, y);
    if (cluster_offsets[tile] == cluster_offsets[tile + 1]) return;
    Pixels pixels = pixels_of_item(view, x, y, order);
    GBuffer g = {gbuffer, layout, view, 0};
    FV depth01 = load_depth01(g, pixels);
    MASK drawn = lane_mask(depth01 > fv(0.0f)) & within_width(view, pixels);
    if (!lane_any(drawn)) return;
    FV z = view_depth(view, pixels.x, pixels.y, lane_select(drawn, depth01, fv(1.0f)));
    FV3 p = load_position(g, pixels, z);
    FV3 n = load_normal(g, pixels);
    UV slice = fine_slice_of_depth(grid, z);
    SeenLights out = {(UV)(0u), (UV)(0u)};
    uint end = min(cluster_offsets[tile + 1], cluster_capacity);
    for (uint i = cluster_offsets[tile]; i < end; ++i) {
        MASK mine = lane_mask(slice == (UV)(clusters[i].slice)) & drawn;
        if (!lane_any(mine)) continue;
        ShadowBits bits =
            bits_of_cluster(shadow_words_of_tiles + shadow_offsets[tile], clusters + i, place);
        SeenLights sum = count_directional(n, directional, directional_count, bits);
        sum = count_list(sum, p, n, bounds, lists + clusters[i].list_begin, clusters[i].list_count,
                         bits, directional_count);
        out.facing = select(out.facing, sum.facing, lane_bits(mine));
        out.seen = select(out.seen, sum.seen, lane_bits(mine));
    }
    uint of_facing[VW], of_seen[VW];
    int is_drawn[VW];
    lane_store(out.facing, of_facing);
    lane_store(out.seen, of_seen);
    lane_store(drawn, is_drawn);
    for (uint i = 0; i < VW; ++i) {
        if (is_drawn[i] == 0) continue;
        facing[pixels.place[i]] = of_facing[i];
        seen[pixels.place[i]] = of_seen[i];
    }
}
