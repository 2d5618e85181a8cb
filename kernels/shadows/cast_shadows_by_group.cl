// SPDX-License-Identifier: Apache-2.0
// cast_shadows by work-groups. Several have the same tile and share its lights. A step either tests
// the children of GROUP / SHADOW_WIDTH nodes, one for each item; or it sets up GROUP triangles, one
// for each item, and tests them on the points that face the light, POINTS_AT_ONCE of an item at a
// time. For GPUs, fastest where GROUP is the number of items that run in step; one pixel a lane.
// The order in which items find triangles does not change the result.
#define ORDERED_PIXELS 1
#define SHADOW_POINTS 1  // of ShadowPoints: one at a time
#include "kernels/shadows/area_group.h"
#include "kernels/shadows/shadow_group.h"

// Points that an item tests at once, on forms that it loads once.
#define POINTS_AT_ONCE 2u  // lit_of_points() chooses between two

static inline float4 float4_of(ShadowForm form) {
    return (float4)(form.g.x, form.g.y, form.g.z, form.c);
}

// The forms of the item's triangle, if it may shade.
static inline void set_up_found(ShadowScene scene, ShadowLight light, uint child,
                                local GroupWalk* walk) {
    FV3 v[3];
    load_casters(scene, &child, v);
#if AREA_SHADOWS
    if (light.is_area) {
        set_up_corners(v, light, child, walk);
        return;
    }
#endif
    MASK sure;
    ShadowTriangles t = set_up_shadow(v, shared_light(light), scene.view.extent, &sure);
    if (!lane_any(sure & may_shade(walk->shaft, &t))) return;
    uint number = atomic_inc(&walk->tested);
    if ((child & SHADOW_MASKED) != 0u) atomic_or(&walk->masked[number / 32u], 1u << number % 32u);
    local float4* to = walk->forms[number];
    for (uint i = 0; i < 3; ++i) to[i] = float4_of(t.edge[i]);
    to[3] = float4_of(t.plane);
    to[4] = (float4)(t.unit[0], t.unit[1], t.unit[2], as_float(child));
}

static inline float form4_at(float4 f, FV3 x) {
    return fma(f.x, x.x, fma(f.y, x.y, fma(f.z, x.z, f.w)));
}

// Whether any of the triangles first + i hides the point, where bit i of `bits` is set. It tests
// boxes and alpha, for triangles whose forms alone do not decide.
static inline bool is_hidden_by_any(ShadowScene scene, ShadowLight light,
                                    local const GroupWalk* walk, uint first, uint bits, FV3 point) {
    FV3 e = edge_point(light, point);
    bool hidden = false;
    for (; bits != 0u && !hidden; bits &= bits - 1u) {
        local const float4* f = walk->forms[first + lowest_bit(bits)];
        FV u0 = form4_at(f[0], e);
        FV u1 = form4_at(f[1], e);
        FV u2 = form4_at(f[2], e);
        uint child = as_uint(f[4].w);
        hidden = true;
        // A ray that surely passes the triangle passes its box.
        if (min(min(u0, u1), u2) < 1.0f) {
            FV3 v[3];
            load_casters(scene, &child, v);
            hidden = passes_box(shared_light(light), point, boxes_of(v));
        }
#if HAS_MASKED_CASTERS
        if (hidden && (child & SHADOW_MASKED) != 0u) {
            CasterWeights w = caster_weights(u0 * f[4].x, u1 * f[4].y, u2 * f[4].z);
            hidden = is_opaque_at(scene.masked, child & SHADOW_NUMBER, w);
        }
#endif
    }
    return hidden;
}

// Tests triangles first .. end - 1, 32 at most, on points k .. k + POINTS_AT_ONCE - 1 of the item.
// lit: a bit for each point. Returns those that stay lit. Boxes and alpha come in a second loop:
// they are rare, and take registers.
static inline uint lit_of_points(ShadowScene scene, ShadowLight light, local const GroupWalk* walk,
                                 uint first, uint end, uint k, uint lit, ShadowPoints* counted) {
    FV3 p[POINTS_AT_ONCE], e[POINTS_AT_ONCE];
    uint unsure[POINTS_AT_ONCE];  // bits of triangles
    uint masked = walk->masked[first / 32u];
#pragma unroll
    for (uint h = 0; h < POINTS_AT_ONCE; ++h) {
        p[h] = faced_point(walk, (k + h) * GROUP + this_item());
        e[h] = edge_point(light, p[h]);
        unsure[h] = 0u;
    }
    for (uint j = first; lit != 0u && j < end; ++j) {
        ADD_COUNT(counted, points, popcount(lit));
        local const float4* f = walk->forms[j];
        float4 f0 = f[0], f1 = f[1], f2 = f[2], f3 = f[3];
        bool may_have_holes = (masked >> j % 32u & 1u) != 0u;
#pragma unroll
        for (uint h = 0; h < POINTS_AT_ONCE; ++h) {
            FV inside = min(min(form4_at(f0, e[h]), form4_at(f1, e[h])), form4_at(f2, e[h]));
            if (!(min(inside, form4_at(f3, p[h])) >= -1.0f)) continue;
            if (inside >= 1.0f && !may_have_holes) {
                lit &= ~(1u << h);
            } else {
                unsure[h] |= 1u << j % 32u;
            }
        }
    }
#pragma unroll 1
    for (uint h = 0; h < POINTS_AT_ONCE; ++h) {
        uint bits = h == 0u ? unsure[0] : unsure[POINTS_AT_ONCE - 1u];
        if ((lit >> h & 1u) == 0u || bits == 0u) continue;
        FV3 point = faced_point(walk, (k + h) * GROUP + this_item());
        if (is_hidden_by_any(scene, light, walk, first, bits, point)) lit &= ~(1u << h);
    }
    return lit;
}

// Tests the triangles that are set up on the item's points. Point k of an item is the (k * GROUP +
// this_item())-th that faces the light. lit: in/out, a bit for each of them. Returns whether any
// stays lit.
static inline bool shade_points(ShadowScene scene, ShadowLight light, local const GroupWalk* walk,
                                uint* lit, ShadowPoints* counted) {
    const uint all = (1u << POINTS_AT_ONCE) - 1u;
    for (uint k = 0; k * GROUP < walk->faced; k += POINTS_AT_ONCE) {
        uint mine = *lit >> k & all;
        for (uint first = 0; mine != 0u && first < walk->tested; first += 32u) {
            uint end = min(first + 32u, walk->tested);
            mine = lit_of_points(scene, light, walk, first, end, k, mine, counted);
        }
        *lit = (*lit & ~(all << k)) | mine << k;
    }
    return *lit != 0u;
}

// Tests the last GROUP of `count` found triangles, or all if there are fewer, and takes them off
// the list.
static inline void test_found(ShadowScene scene, ShadowLight light, uint count,
                              local GroupWalk* walk, uint* lit, ShadowPoints* counted) {
    uint first = count > GROUP ? count - GROUP : 0u;
    ADD_COUNT(counted, triangles, count - first);
    if (this_item() == 0u) {
        walk->count = first;
        walk->tested = 0u;
        walk->lit = 0u;
        for (uint i = 0; i < GROUP / 32u; ++i) walk->masked[i] = 0u;
#if AREA_SHADOWS
        walk->rays.pair_count[0] = 0u;
#endif
    }
    barrier(CLK_LOCAL_MEM_FENCE);  // 0 before any adds to it
    uint i = first + this_item();
    if (i < count) set_up_found(scene, light, walk->found[i], walk);
    barrier(CLK_LOCAL_MEM_FENCE);  // all are set up
#if AREA_SHADOWS
    bool any = light.is_area ? shade_rays(scene, light, walk, counted)
                             : shade_points(scene, light, walk, lit, counted);
#else
    bool any = shade_points(scene, light, walk, lit, counted);
#endif
    if (any) walk->lit = 1u;
}

// The group's counts, of which all items have the same nodes, triangles and shafts.
static inline void store_counts(const ShadowPoints* counted, local GroupWalk* walk,
                                global ShadowCounts* to) {
#if COUNT_SHADOWS
    walk->counts[this_item()] = counted->counts;
    barrier(CLK_LOCAL_MEM_FENCE);  // all are there
    if (this_item() != 0u) return;
    ShadowCounts sum = counted->counts;
    for (uint i = 1; i < GROUP; ++i) {
        sum.rays += walk->counts[i].rays;
        sum.met_rays += walk->counts[i].met_rays;
        sum.seen += walk->counts[i].seen;
        sum.points += walk->counts[i].points;
    }
    *to = sum;
#endif
}

// Clears the bits of the item's points that a triangle hides from the light. walk->box must be
// complete.
static inline void cast_shadows_of_group(ShadowScene scene, ShadowLight light,
                                         local GroupWalk* walk, uint* lit, ShadowPoints* counted) {
    if (this_item() == 0u) {
        walk->shaft = make_shaft(light, box_end(walk->box.low), box_end(walk->box.high));
    }
    GroupStack stack = {1u, 0u};
    bool begins = true;
    for (;;) {
        barrier(CLK_LOCAL_MEM_FENCE);  // shaft, stack and found are complete
        uint top = stack_top(&stack, walk);
        uint count = walk->count;
        bool goes_on = walk->lit != 0u && (top > 0u || count > 0u);
        ADD_COUNT(counted, shafts, begins && goes_on ? 1 : 0);
        begins = false;
        if (!goes_on) break;  // for all items
        if (top > 0u && count <= GROUP) {
            uint take = nodes_to_take(scene.view, top);
            ADD_COUNT(counted, nodes, take);
            walk_nodes(scene, top, take, &stack, walk);
        } else {
            barrier(CLK_LOCAL_MEM_FENCE);  // read by all before it changes
            test_found(scene, light, count, walk, lit, counted);
        }
    }
}

// Packs four bytes, each 0 or 1, into bits 0 .. 3; the lowest byte becomes bit 0.
static inline uint bits_of_bytes(uint bytes) { return bytes * 0x01020408u >> 24; }

// Words of the cluster's flags: an item writes a byte at a time.
static inline void store_words(uint first, uint end, local GroupWalk* walk, global uint* words) {
    uint count = shadow_words(first, end);
    local const uint* first_flags = walk->flags + first / 32u * 8u;
    for (uint i = this_item(); i < count * 4u; i += GROUP) {
        local const uint* eight = first_flags + 2u * i;
        uint bits = bits_of_bytes(eight[0]) | bits_of_bytes(eight[1]) << 4;
#if PICKED_ONLY
        ((global uchar*)words)[i] &= (uchar)~bits;
#else
        ((global uchar*)words)[i] = (uchar)bits;
#endif
    }
}

// Gathers the points that face the light, about a third of a cluster's, so that all items are busy,
// and their box.
static inline void gather_faced(ClusterCast cast, ShadowLight light, global const uint* words,
                                local GroupWalk* walk) {
    LaneBox box = no_box();
    bool any = false;
    for (uint place = cast.first + this_item(); place < cast.end; place += GROUP) {
        MASK mine = (MASK)(-1);
#if PICKED_ONLY
        mine = lane_mask((words[place / 32u - cast.first / 32u] >> place % 32u & 1u) != 0u);
#endif
        ShadowPoints point;
        FV3 p = point_at(walk, place), n = unpacked_normal(walk->normal[place]);
        store_point(&point, 0u, p, n);
        if (!lane_any(face_light(cast.scene.view, &point, 0u, light, mine))) continue;
        box = grown_box(box, (MASK)(-1), p);
        walk->places[atomic_inc(&walk->faced)] = (uchar)place;
        any = true;
    }
    if (any) {
        grow_box(&walk->box, box);
        walk->lit = 1u;
    }
}

// A bit for each of the item's gathered points.
static inline uint bits_of_faced(local const GroupWalk* walk) {
    uint count = (walk->faced + GROUP - 1u - this_item()) / GROUP;
    return (1u << count) - 1u;
}

// Sets the flags of the item's points that are lit.
static inline void flag_lit(uint lit, local GroupWalk* walk) {
    for (; lit != 0u; lit &= lit - 1u) {
        uint place = walk->places[lowest_bit(lit) * GROUP + this_item()];
        ((local uchar*)walk->flags)[place] = 1u;
    }
}

// One light's bits of one cluster.
static inline void cast_light(ClusterCast cast, uint j, local GroupWalk* walk,
                              ShadowPoints* counted) {
    ShadowLight light = light_of_cast(cast, j);
#if AREA_SHADOWS
    if (light.is_area) return;
#endif
    global uint* words = words_of_light(cast, j);
    barrier(CLK_LOCAL_MEM_FENCE);  // the last light is done
    begin_walk(walk);
    empty_box(&walk->box);
    // Of all places: store_words() reads whole words.
    for (uint i = this_item(); i < FINE_TILE_PIXELS / 4u; i += GROUP) walk->flags[i] = 0u;
    barrier(CLK_LOCAL_MEM_FENCE);  // empty before any adds to it
    gather_faced(cast, light, words, walk);
    barrier(CLK_LOCAL_MEM_FENCE);  // all are gathered
    uint lit = bits_of_faced(walk);
    uint rays = popcount(lit);
    ulong tests_before = counted_tests(counted);
    cast_shadows_of_group(cast.scene, light, walk, &lit, counted);
    count_rays(counted, tests_before, rays, popcount(lit));
    flag_lit(lit, walk);
    // All flags are set, and all have read the words.
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    store_words(cast.first, cast.end, walk, words);
}

#if AREA_SHADOWS
// One light's bits, if it has a size; whether it has.
static inline bool cast_area_light(ClusterCast cast, uint j, AreaPixels pixels,
                                   local GroupWalk* walk, ShadowPoints* counted) {
    ShadowLight light = light_of_cast(cast, j);
    if (!light.is_area) return false;
    global uint* words = words_of_light(cast, j);
    LeftBits left = {this_item(), 0u};
    bool goes_on = true;
    while (goes_on) {
        take_rays(words, slots_of(cast.from, j) * cast.count, &left, walk);
        ulong tests_before = counted_tests(counted);
        uint rays = make_rays(cast, pixels, light, walk);
        light.area.low = box_end(walk->rays.targets_box.low);
        light.area.high = box_end(walk->rays.targets_box.high);
        uint none = 0u;  // points: these are rays
        cast_shadows_of_group(cast.scene, light, walk, &none, counted);
        count_rays(counted, tests_before, rays, put_seen(words, &walk->rays));
        goes_on = walk->rays.any_left != 0u;
    }
    return true;
}

// The bits of the group's lights with a size of one cluster, from the start-th on; whether there
// are other lights.
static inline bool cast_area_lights(ClusterCast cast, uint start, AreaPixels pixels,
                                    local GroupWalk* walk, ShadowPoints* counted) {
    bool others = false;
    uint count = count_of_cluster(cast.from, cast.cluster);
    for (uint j = start; j < count; j += 32u * cast.split) {
        for (uint bits = find_wanted(cast, j, walk); bits != 0u; bits &= bits - 1u) {
            uint light = j + lowest_bit(bits) * cast.split;
            others |= !cast_area_light(cast, light, pixels, walk, counted);
        }
    }
    return others;
}
#endif

// The bits of the group's lights without a size of one cluster, from the start-th on.
static inline void cast_lights(ClusterCast cast, uint start, local GroupWalk* walk,
                               ShadowPoints* counted) {
    uint count = count_of_cluster(cast.from, cast.cluster);
    for (uint j = start; j < count; j += 32u * cast.split) {
        for (uint bits = find_wanted(cast, j, walk); bits != 0u; bits &= bits - 1u) {
            cast_light(cast, j + lowest_bit(bits) * cast.split, walk, counted);
        }
    }
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void cast_shadows(
    LIT_ARGS, SHADOW_ARGS, TARGET_ARGS, SAMPLE_ARGS,
    global ShadowCounts* restrict counts,  // out [tiles * split] with COUNT_SHADOWS, where the
                                           // tile has lights
    global const uint* restrict tiles) {   // of order_tiles
    local GroupWalk walk;
    uint split = get_num_groups(0) / fine_tile_count(view);  // groups for each tile
    uint tile = tiles[get_group_id(0) / split];
    if (!HAS_USABLE_WORDS(tile)) return;
    Clusters active = CLUSTERS_OF_ARGS;
    ClusterCast cast = {SHADOW_SCENE_OF_ARGS, CAST_LIGHTS_OF_ARGS};
    cast.key = key_of_tile(view, cast.from, tile);
    cast.kept = kept;
    cast.split = split;
    ShadowPoints counted;
    reset_counts(&counted);
    uint start = get_group_id(0) % split;  // the group's first light of a cluster
    FOR_EACH_CLUSTER(i, active, tile) {
        cast.cluster = clusters + i;
        cast.first = clusters[i].first_pixel;
        cast.end = cast.first + clusters[i].pixel_count;
        cast.count = shadow_words(cast.first, cast.end);
        cast.words_begin = word_offsets[tile] + clusters[i].first_word;
        cast.words = words + cast.words_begin;
        uint count = count_of_cluster(cast.from, cast.cluster);
        bool others = start < count;
#if AREA_SHADOWS
        AreaPixels pixels = {GBUFFER_OF_ARGS, origins, order, tile};
        others = others && cast_area_lights(cast, start, pixels, &walk, &counted);
#endif
        if (others) {
            share_points(view, origins, tile, order, cast.first, cast.end, &walk);
            cast_lights(cast, start, &walk, &counted);
        }
        // The first light of the next cluster goes to the group after that of the last one here.
        start = (start + split - count % split) % split;
    }
#if COUNT_SHADOWS
    store_counts(&counted, &walk, counts + get_group_id(0));
#endif
}
