// SPDX-License-Identifier: Apache-2.0
// Counts per pixel the lights, directional ones too, that it faces within their range, and those of
// them that no caster hides. For views; no part of a frame otherwise. Exact shadows only: it takes
// each light to have one slot.
// One work-item counts for VW pixels, neighbours in the order of their tile's clusters.
#define ORDERED_PIXELS 1
#include "kernels/device/lit_item.h"
#include "kernels/shadows/shadow_bits.h"

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

kernel void count_seen(LIT_ARGS, WORD_ARGS(const),
                       global uint* restrict facing,  // out [height][stride]; background is left
                       global uint* restrict seen) {  // out, likewise
    BEGIN_ORDERED_ITEM;
    FV3 p = load_position(g, item.pixels, item.z);
    FV3 n = load_normal(g, item.pixels);
    SeenLights out = {(UV)(0u), (UV)(0u)};
    FOR_EACH_CLUSTER_OF(item, i, mine, active, at.tile) {
        ShadowBits bits =
            bits_of_cluster(words + word_offsets[at.tile], clusters + i, place_of_item(at.x, at.y));
        SeenLights sum = count_directional(n, directional_lights, directional_count, bits);
        sum = count_list(sum, p, n, bounds, lists + clusters[i].list_begin, clusters[i].list_count,
                         bits, directional_count);
        out.facing = select(out.facing, sum.facing, lane_bits(mine));
        out.seen = select(out.seen, sum.seen, lane_bits(mine));
    }
    uint of_facing[VW], of_seen[VW];
    int is_shown[VW];
    lane_store(out.facing, of_facing);
    lane_store(out.seen, of_seen);
    lane_store(item.shown, is_shown);
    for (uint i = 0; i < VW; ++i) {
        if (is_shown[i] == 0) continue;
        facing[item.pixels.place[i]] = of_facing[i];
        seen[item.pixels.place[i]] = of_seen[i];
    }
}
