// SPDX-License-Identifier: Apache-2.0
// A work-group casts a light's rays. First an item takes a ray and finds its target. Then an item
// takes a pair of ray and triangle and tests the triangle's box. Few pairs pass; the items share
// these for the full test.
#ifndef KILOLUX_DEVICE_AREA_GROUP_H
#define KILOLUX_DEVICE_AREA_GROUP_H
#include "kernels/shadows/shadow_group.h"

#if AREA_SHADOWS
// An item's position in a light's words: the remaining bits of one word, and the next word (every
// GROUP-th).
typedef struct LeftBits {
    uint word, bits;
} LeftBits;

// Where pixels' rays begin.
typedef struct AreaPixels {
    GBuffer g;
    global const float* origins;
    global const uchar* order;
    uint tile;
} AreaPixels;

static inline uint ray_count(local const GroupRays* rays) { return min(rays->count, GROUP_RAYS); }

// Takes picked rays while there is room. words: of the light, `count` in all.
static inline void take_rays(global const uint* words, uint count, LeftBits* left,
                             local GroupWalk* walk) {
    local GroupRays* rays = &walk->rays;
    barrier(CLK_LOCAL_MEM_FENCE);  // the last rays are done
    if (this_item() == 0u) rays->count = rays->any_left = 0u;
    empty_box(&walk->box);
    empty_box(&rays->targets_box);
    begin_walk(walk);
    barrier(CLK_LOCAL_MEM_FENCE);  // empty before any adds to it
    while (left->bits != 0u || left->word < count) {
        if (left->bits == 0u) {
            left->bits = words[left->word];
            left->word += GROUP;
            continue;
        }
        uint i = atomic_inc(&rays->count);
        if (i >= GROUP_RAYS) {
            rays->any_left = 1u;
            break;
        }
        rays->bits[i] = (left->word - GROUP) * 32u + lowest_bit(left->bits);
        left->bits &= left->bits - 1u;
    }
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);  // words are read before they change
}

// Finds the ends of the rays; the number of the item's lit ones.
static inline uint make_rays(ClusterCast cast, AreaPixels from, ShadowLight light,
                             local GroupWalk* walk) {
    local GroupRays* rays = &walk->rays;
    View view = from.g.view;
    uint lit_count = 0u;
    for (uint i = this_item(); i < ray_count(rays); i += GROUP) {
        uint word = rays->bits[i] / 32u;
        uint place = cast.first / 32u * 32u + word % cast.count * 32u + rays->bits[i] % 32u;
        Pixels pixels = pixels_of_tile(view, from.tile, place, from.order);
        ShadowPoints ray;
        load_origins(&ray, 0u, from.origins, view.stride * view.height, pixels);
        load_area_pixels(&ray, 0u, from.g, pixels);
        ShadowLight target = light_at_slot(cast.from, light, word / cast.count);
        MASK lit = face_light(cast.scene.view, &ray, 0u, target, (MASK)(-1));
        FV3 p = load_points(&ray, 0u), e = load_ray_ends(&ray, 0u);
        rays->origins[i] = (float4)(p.x, p.y, p.z, 0.0f);
        rays->targets[i] = (float4)(e.x, e.y, e.z, 0.0f);
        rays->lit[i] = lane_count(lit);
        if (!lane_any(lit)) continue;
        grow_box(&walk->box, (LaneBox){p, p});
        grow_box(&rays->targets_box, (LaneBox){e, e});
        walk->lit = 1u;
        ++lit_count;
    }
    barrier(CLK_LOCAL_MEM_FENCE);  // all rays and boxes are complete
    return lit_count;
}

// The item's triangle, if it may hide a target.
static inline void set_up_corners(const FV3* v, ShadowLight light, uint child,
                                  local GroupWalk* walk) {
    if (!lane_any(may_part(walk->shaft, light, v))) return;
    LaneBoxes box = boxes_of(v);
    local float4* to = walk->forms[atomic_inc(&walk->tested)];
    for (uint i = 0; i < 3; ++i) to[i] = (float4)(v[i].x, v[i].y, v[i].z, as_float(child));
    to[3] = (float4)(box.middle.x, box.middle.y, box.middle.z, 0.0f);
    to[4] = (float4)(box.half_edge.x, box.half_edge.y, box.half_edge.z, 0.0f);
}

static inline FV3 fv3_of(float4 v) { return fv3(v.x, v.y, v.z); }

// Lists the pairs of lit rays and triangles, of GROUP_PAIRS from `first` on, whose ray passes the
// triangle's box.
static inline void find_pairs(LaneLight light, uint first, local uint* count, local GroupWalk* walk,
                              ShadowPoints* counted) {
    local GroupRays* rays = &walk->rays;
    uint end = min(first + GROUP_PAIRS, walk->tested * ray_count(rays));
    for (uint pair = first + this_item(); pair < end; pair += GROUP) {
        uint t = pair / ray_count(rays), ray = pair % ray_count(rays);
        if (rays->lit[ray] == 0u) continue;
        ADD_COUNT(counted, points, 1);
        LaneBoxes box = {fv3_of(walk->forms[t][3]), fv3_of(walk->forms[t][4])};
        light.at = fv3_of(rays->targets[ray]);
        if (!lane_any(passes_box(light, fv3_of(rays->origins[ray]), box))) continue;
        rays->pairs[atomic_inc(count)] = (ushort)(t * GROUP_RAYS + ray);
    }
}

static inline void test_pairs(ShadowScene scene, LaneLight light, uint count,
                              local GroupWalk* walk) {
    local GroupRays* rays = &walk->rays;
    for (uint i = this_item(); i < count; i += GROUP) {
        uint ray = rays->pairs[i] % GROUP_RAYS;
        local const float4* f = walk->forms[rays->pairs[i] / GROUP_RAYS];
        FV3 v[3] = {fv3_of(f[0]), fv3_of(f[1]), fv3_of(f[2])};
        light.at = fv3_of(rays->targets[ray]);
        FV3 origin = fv3_of(rays->origins[ray]);
        if (lane_any(hidden_in_box(v, as_uint(f[0].w), scene, light, origin, (MASK)(-1)))) {
            rays->lit[ray] = 0u;
        }
    }
}

// Tests the triangles that are set up on all rays; whether any of the item's is still lit.
static inline bool shade_rays(ShadowScene scene, ShadowLight light, local GroupWalk* walk,
                              ShadowPoints* counted) {
    local GroupRays* rays = &walk->rays;
    LaneLight at = shared_light(light);
    uint round = 0u;
    for (uint first = 0; first < walk->tested * ray_count(rays); first += GROUP_PAIRS) {
        find_pairs(at, first, &rays->pair_count[round], walk, counted);
        barrier(CLK_LOCAL_MEM_FENCE);  // all pairs are listed
        uint count = rays->pair_count[round];
        round ^= 1u;
        if (this_item() == 0u) rays->pair_count[round] = 0u;
        test_pairs(scene, at, count, walk);
        barrier(CLK_LOCAL_MEM_FENCE);  // all are tested, and the next round's number is 0
    }
    uint lit = 0u;
    for (uint i = this_item(); i < ray_count(rays); i += GROUP) lit |= rays->lit[i];
    return lit != 0u;
}

// Clears the bits of rays that nothing hides; the number of the item's.
static inline uint put_seen(global uint* words, local const GroupRays* rays) {
    uint seen = 0u;
    for (uint i = this_item(); i < ray_count(rays); i += GROUP) {
        if (rays->lit[i] == 0u) continue;
        atomic_and(words + rays->bits[i] / 32u, ~(1u << rays->bits[i] % 32u));
        ++seen;
    }
    return seen;
}
#endif
#endif
