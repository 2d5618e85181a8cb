// SPDX-License-Identifier: Apache-2.0
// cast_shadows by a work-group for every SPLIT-th light of a tile: the items test the children of
// GROUP / SHADOW_WIDTH nodes at a time, an item a child; then triangles, an item each; then those
// of the points that face the light, an item a few. For GPUs; one pixel a lane. The order in which
// items find triangles does not change the result.
#define ORDERED_PIXELS 1
#define SHADOW_POINTS (FINE_TILE_PIXELS / GROUP)
#include "kernels/shadows/area_group.h"
#include "kernels/shadows/shadow_group.h"

// Place in the tile's order of the item's k-th point of a cluster whose first pixel is `first`.
static inline uint place_of_point(uint first, uint k) { return first + k * GROUP + this_item(); }

// The item's points of a cluster.
static inline void load_points_of_item(View view, global const float* origins, uint tile,
                                       global const uchar* order, uint first, uint end,
                                       ShadowPoints* points) {
    points->row_count = (end - first + GROUP - 1u) / GROUP;
#pragma unroll
    for (uint k = 0; k < SHADOW_POINTS; ++k) {
        uint place = min(place_of_point(first, k), end - 1u);
        Pixels pixels = pixels_of_tile(view, tile, place, order);
        load_origins(points, k, origins, view.stride * view.height, pixels);
    }
}

static inline float4 float4_of(ShadowForm form) {
    return (float4)(form.g.x, form.g.y, form.g.z, form.c);
}

// The forms of the item's triangle, if it may shade.
static inline void set_up_found(ShadowScene scene, ShadowLight light, Shaft shaft, uint child,
                                local GroupWalk* walk) {
    FV3 v[3];
    load_casters(scene, &child, v);
#if AREA_SHADOWS
    if (light.is_area) {
        set_up_corners(v, light, shaft, child, walk);
        return;
    }
#endif
    MASK sure;
    ShadowTriangles t = set_up_shadow(v, shared_light(light), scene.view.extent, &sure);
    if (!lane_any(sure & may_shade(shaft, &t))) return;
    local float4* to = walk->forms[atomic_inc(&walk->tested)];
    for (uint i = 0; i < 3; ++i) to[i] = float4_of(t.edge[i]);
    to[3] = float4_of(t.plane);
    to[4] = (float4)(t.unit[0], t.unit[1], t.unit[2], as_float(child));
}

static inline float form4_at(float4 f, FV3 x) {
    return fma(f.x, x.x, fma(f.y, x.y, fma(f.z, x.z, f.w)));
}

// Tests the triangles that are set up on the item's points; whether any is still lit.
static inline bool shade_points(ShadowScene scene, ShadowLight light, local const GroupWalk* walk,
                                ShadowPoints* points) {
    MASK any = 0;
#pragma unroll
    for (uint k = 0; k < SHADOW_POINTS; ++k) {
        if (k < points->row_count) any |= lit_of(points, k);
    }
    for (uint j = 0; lane_any(any) && j < walk->tested; ++j) {
        local const float4* f = walk->forms[j];
        float4 f0 = f[0], f1 = f[1], f2 = f[2], f3 = f[3];
        any = 0;
#pragma unroll
        for (uint k = 0; k < SHADOW_POINTS; ++k) {
            if (k >= points->row_count) continue;  // the same for all items
            MASK lit = lit_of(points, k);
            ADD_COUNT(points, points, lane_count(lit));
            FV3 e = load_ray_ends(points, k);
            FV u0 = form4_at(f0, e);
            FV u1 = form4_at(f1, e);
            FV u2 = form4_at(f2, e);
            FV behind = form4_at(f3, load_points(points, k));
            FV inside = min(min(u0, u1), u2);
            MASK shaded = lane_mask(min(inside, behind) >= -1.0f) & lit;
            // A ray that surely passes the triangle passes its box.
            if (shaded && inside < 1.0f) {
                FV3 v[3];
                uint child = as_uint(f[4].w);
                load_casters(scene, &child, v);
                shaded = passes_box(shared_light(light), load_points(points, k), boxes_of(v));
            }
#if HAS_MASKED_CASTERS
            if (shaded && (as_uint(f[4].w) & SHADOW_MASKED) != 0u) {
                CasterWeights w = caster_weights(u0 * f[4].x, u1 * f[4].y, u2 * f[4].z);
                shaded &= is_opaque_at(scene.masked, as_uint(f[4].w) & SHADOW_NUMBER, w);
            }
#endif
            lit &= ~shaded;
            points->lit[k] = as_float(lit);
            any |= lit;
        }
    }
    return lane_any(any);
}

// Tests what was found, GROUP triangles at a time.
static inline void test_found(ShadowScene scene, ShadowLight light, Shaft shaft, uint count,
                              local GroupWalk* walk, ShadowPoints* points) {
    ADD_COUNT(points, triangles, count);
    for (uint first = 0; first < count; first += GROUP) {
        if (this_item() == 0u) {
            walk->tested = 0u;
            walk->lit = 0u;
#if AREA_SHADOWS
            walk->rays.pair_count[0] = 0u;
#endif
        }
        barrier(CLK_LOCAL_MEM_FENCE);  // 0 before any adds to it
        uint i = first + this_item();
        if (i < count) set_up_found(scene, light, shaft, walk->found[i], walk);
        barrier(CLK_LOCAL_MEM_FENCE);  // all are set up
#if AREA_SHADOWS
        bool lit = light.is_area ? shade_rays(scene, light, walk, points)
                                 : shade_points(scene, light, walk, points);
#else
        bool lit = shade_points(scene, light, walk, points);
#endif
        if (lit) walk->lit = 1u;
        barrier(CLK_LOCAL_MEM_FENCE);  // all have tested
    }
}

// The group's counts, of which all items have the same nodes, triangles and shafts.
static inline void store_counts(const ShadowPoints* points, local GroupWalk* walk,
                                global ShadowCounts* to) {
#if COUNT_SHADOWS
    walk->counts[this_item()] = points->counts;
    barrier(CLK_LOCAL_MEM_FENCE);  // all are there
    if (this_item() != 0u) return;
    ShadowCounts sum = points->counts;
    for (uint i = 1; i < GROUP; ++i) {
        sum.rays += walk->counts[i].rays;
        sum.met_rays += walk->counts[i].met_rays;
        sum.seen += walk->counts[i].seen;
        sum.points += walk->counts[i].points;
    }
    *to = sum;
#endif
}

// Clears the lit flag of each of the item's points that a triangle hides from the light.
static inline void cast_shadows_of_group(ShadowScene scene, ShadowLight light, Shaft shaft,
                                         local GroupWalk* walk, ShadowPoints* points) {
    bool goes_on = true;
    bool begins = true;
    while (goes_on) {
        barrier(CLK_LOCAL_MEM_FENCE);  // stack and found are complete
        uint top = walk->top;
        uint count = walk->count;
        goes_on = walk->lit != 0u && (top > 0u || count > 0u);
        ADD_COUNT(points, shafts, begins && goes_on ? 1 : 0);
        begins = false;
        barrier(CLK_LOCAL_MEM_FENCE);  // read by all before it changes
        if (goes_on && (top == 0u || count > GROUP)) {
            test_found(scene, light, shaft, count, walk, points);
            if (this_item() == 0u) walk->count = 0u;
        } else if (goes_on) {
            uint take = nodes_to_take(scene.view, top);
            ADD_COUNT(points, nodes, take);
            walk_nodes(scene, shaft, top, take, walk);
        }
    }
}

// Words of the cluster's flags: an item writes a byte at a time.
static inline void store_words(uint first, uint end, local GroupWalk* walk, global uint* words) {
    uint count = shadow_words(first, end);
    uint from = first / 32u * 32u;
    for (uint i = this_item(); i < count * 4u; i += GROUP) {
        uint bits = 0u;
        for (uint bit = 0; bit < 8u; ++bit) {
            uint place = from + i * 8u + bit;
            if (place >= first && place < end && walk->flags[place]) bits |= 1u << bit;
        }
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
                                ShadowPoints* points, local GroupWalk* walk) {
    LaneBox box = no_box();
    bool any = false;
#pragma unroll
    for (uint k = 0; k < SHADOW_POINTS; ++k) {
        if (k >= points->row_count) continue;
        uint place = place_of_point(cast.first, k);
        MASK mine = lane_mask(place < cast.end);
#if PICKED_ONLY
        mine &= lane_mask(place < cast.end &&
                          (words[place / 32u - cast.first / 32u] >> place % 32u & 1u));
#endif
        MASK lit = face_light(cast.scene.view, points, k, light, mine);
        if (!lane_any(lit)) continue;
        FV3 p = load_points(points, k);
        box = grown_box(box, lit, p);
        uint i = atomic_inc(&walk->faced);
        walk->places[i] = (uchar)place;
        walk->x[i] = p.x, walk->y[i] = p.y, walk->z[i] = p.z;
        any = true;
    }
    if (any) {
        grow_box(&walk->box, box);
        walk->lit = 1u;
    }
}

// The item's gathered points, all of them lit; their number.
static inline uint load_faced(ShadowLight light, local const GroupWalk* walk, ShadowPoints* to) {
    uint count = 0u;
    to->row_count = (walk->faced + GROUP - 1u) / GROUP;
#pragma unroll
    for (uint k = 0; k < SHADOW_POINTS; ++k) {
        if (k >= to->row_count) continue;
        uint i = place_of_point(0u, k);
        uint from = min(i, walk->faced - 1u);
        FV3 p = fv3(walk->x[from], walk->y[from], walk->z[from]);
        FV3 e = edge_point(light, p);
        to->x[k] = p.x, to->y[k] = p.y, to->z[k] = p.z;
        to->ex[k] = e.x, to->ey[k] = e.y, to->ez[k] = e.z;
        to->lit[k] = as_float(lane_mask(i < walk->faced));
        if (i < walk->faced) ++count;
    }
    return count;
}

// Sets the flags of the item's points that are lit; their number.
static inline uint flag_lit(const ShadowPoints* faced, local GroupWalk* walk) {
    uint seen = 0u;
#pragma unroll
    for (uint k = 0; k < SHADOW_POINTS; ++k) {
        if (k >= faced->row_count || !lane_any(lit_of(faced, k))) continue;
        walk->flags[walk->places[place_of_point(0u, k)]] = 1u;
        ++seen;
    }
    return seen;
}

// One light's bits of one cluster.
static inline void cast_light(ClusterCast cast, uint j, local GroupWalk* walk,
                              ShadowPoints* points) {
    ShadowLight light = light_of_cast(cast, j);
#if AREA_SHADOWS
    if (light.is_area) return;
#endif
    global uint* words = words_of_light(cast, j);
    barrier(CLK_LOCAL_MEM_FENCE);  // the last light is done
    begin_walk(walk);
    empty_box(&walk->box);
    for (uint i = cast.first + this_item(); i < cast.end; i += GROUP) walk->flags[i] = 0u;
    barrier(CLK_LOCAL_MEM_FENCE);  // empty before any adds to it
    gather_faced(cast, light, words, points, walk);
    barrier(CLK_LOCAL_MEM_FENCE);  // all are gathered
    ShadowPoints faced;
    reset_counts(&faced);
    uint rays = load_faced(light, walk, &faced);
    Shaft shaft = make_shaft(light, box_end(walk->box.low), box_end(walk->box.high));
    cast_shadows_of_group(cast.scene, light, shaft, walk, &faced);
    count_rays(&faced, 0ul, rays, flag_lit(&faced, walk));
    add_counts(points, &faced);
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
        Shaft shaft = make_shaft(light, box_end(walk->box.low), box_end(walk->box.high));
        cast_shadows_of_group(cast.scene, light, shaft, walk, counted);
        count_rays(counted, tests_before, rays, put_seen(words, &walk->rays));
        goes_on = walk->rays.any_left != 0u;
    }
    return true;
}

// The bits of all lights with a size of one cluster; whether there are other lights.
static inline bool cast_area_lights(ClusterCast cast, AreaPixels pixels, local GroupWalk* walk,
                                    ShadowPoints* counted) {
    bool others = false;
    uint count = count_of_cluster(cast.from, cast.cluster);
    for (uint j = get_group_id(0) % SPLIT; j < count; j += 32u * SPLIT) {
        for (uint bits = find_wanted(cast, j, walk); bits != 0u; bits &= bits - 1u) {
            uint light = j + lowest_bit(bits) * SPLIT;
            others |= !cast_area_light(cast, light, pixels, walk, counted);
        }
    }
    return others;
}
#endif

// The bits of the lights without a size of one cluster.
static inline void cast_lights(ClusterCast cast, local GroupWalk* walk, ShadowPoints* points) {
    uint count = count_of_cluster(cast.from, cast.cluster);
    for (uint j = get_group_id(0) % SPLIT; j < count; j += 32u * SPLIT) {
        uint left = (count - j + SPLIT - 1u) / SPLIT;
        uint bits = find_wanted(cast, j, walk) & (0xffffffffu >> (32u - min(left, 32u)));
        for (; bits != 0u; bits &= bits - 1u) {
            cast_light(cast, j + lowest_bit(bits) * SPLIT, walk, points);
        }
    }
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void cast_shadows(
    LIT_ARGS, SHADOW_ARGS, TARGET_ARGS, SAMPLE_ARGS,
    global ShadowCounts* restrict counts,  // out [tiles * SPLIT] with COUNT_SHADOWS, where the
                                           // tile has lights
    global const uint* restrict tiles) {   // of order_tiles
    local GroupWalk walk;
    uint tile = tiles[get_group_id(0) / SPLIT];
    if (!HAS_USABLE_WORDS(tile)) return;
    Clusters active = CLUSTERS_OF_ARGS;
    ClusterCast cast = {SHADOW_SCENE_OF_ARGS, CAST_LIGHTS_OF_ARGS};
    cast.key = key_of_tile(view, cast.from, tile);
    cast.kept = kept;
    ShadowPoints points;
    reset_counts(&points);
    FOR_EACH_CLUSTER(i, active, tile) {
        cast.cluster = clusters + i;
        cast.first = clusters[i].first_pixel;
        cast.end = cast.first + clusters[i].pixel_count;
        cast.count = shadow_words(cast.first, cast.end);
        cast.words_begin = word_offsets[tile] + clusters[i].first_word;
        cast.words = words + cast.words_begin;
#if AREA_SHADOWS
        AreaPixels pixels = {GBUFFER_OF_ARGS, origins, order, tile};
        if (!cast_area_lights(cast, pixels, &walk, &points)) continue;
#endif
        load_points_of_item(view, origins, tile, order, cast.first, cast.end, &points);
        cast_lights(cast, &walk, &points);
    }
#if COUNT_SHADOWS
    store_counts(&points, &walk, counts + get_group_id(0));
#endif
}
