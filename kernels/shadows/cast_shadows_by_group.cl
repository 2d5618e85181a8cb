// SPDX-License-Identifier: Apache-2.0
// cast_shadows by a work-group for every SPLIT-th light of a tile: the items test the children of
// GROUP / SHADOW_WIDTH nodes at a time, an item a child; then triangles, an item each; then points,
// an item a few. For GPUs; one pixel a lane. The order in which items find triangles does not
// change the result.
#define ORDERED_PIXELS 1
#define SHADOW_POINTS (FINE_TILE_PIXELS / GROUP)
#include "kernels/shadows/cast_shadows.h"
#include "kernels/shadows/shadow_cast.h"

#ifndef SPLIT
#define SPLIT 4
#endif
#define NODES_AT_ONCE (GROUP / SHADOW_WIDTH)
// Most triangles that wait for their test.
#define GROUP_FOUND (2 * GROUP)
// float4 of a triangle: its forms, the edges' units with its child's number, its box.
#define FORM_FLOAT4S 5

// The memory that the items share.
typedef struct GroupWalk {
    uint stack[SHADOW_STACK];
    uint found[GROUP_FOUND];
    uint nodes[NODES_AT_ONCE];          // off the stack
    float4 forms[GROUP][FORM_FLOAT4S];  // of the triangles that are tested
    uint top, count;                    // of stack and found
    uint tested;                        // triangles
    uint lit;                           // 1 while some point is
    uchar flags[FINE_TILE_PIXELS];      // of places: 1 where lit
#if COUNT_SHADOWS
    ShadowCounts counts[GROUP];  // of the items: nodes, triangles and shafts by each for all
#endif
    int low[3], high[3];  // of the cluster's points, as ordered_bits
} GroupWalk;

// Floats' order, negative ones included, as integers'; its own inverse on bits.
static inline int ordered_bits(int bits) { return bits ^ (bits >> 31 & 0x7fffffff); }

static inline uint this_item(void) { return get_local_id(0); }

// Place in the tile's order of the item's k-th point of a cluster whose first pixel is `first`.
static inline uint place_of_point(uint first, uint k) { return first + k * GROUP + this_item(); }

// The item's points of a cluster.
static inline void load_points_of_item(GBuffer g, global const float* origins, uint tile,
                                       global const uchar* order, uint first, uint end,
                                       ShadowPoints* points) {
    View view = g.view;
    points->row_count = (end - first + GROUP - 1u) / GROUP;
#pragma unroll
    for (uint k = 0; k < SHADOW_POINTS; ++k) {
        uint place = min(place_of_point(first, k), end - 1u);
        Pixels pixels = pixels_of_tile(view, tile, place, order);
        load_origins(points, k, origins, view.stride * view.height, pixels);
        load_area_pixels(points, k, g, pixels);
    }
}

// The box of the cluster's points.
static inline void find_box(const ShadowPoints* points, local GroupWalk* walk) {
    barrier(CLK_LOCAL_MEM_FENCE);  // the last cluster's is used up
    if (this_item() < 3u) {
        walk->low[this_item()] = ordered_bits(as_int(SHADOW_NOWHERE));
        walk->high[this_item()] = ordered_bits(as_int(-SHADOW_NOWHERE));
    }
    barrier(CLK_LOCAL_MEM_FENCE);  // empty before it grows
#pragma unroll
    for (uint k = 0; k < SHADOW_POINTS; ++k) {
        const float at[3] = {points->x[k], points->y[k], points->z[k]};
#pragma unroll
        for (uint axis = 0; axis < 3; ++axis) {
            atomic_min(&walk->low[axis], ordered_bits(as_int(at[axis])));
            atomic_max(&walk->high[axis], ordered_bits(as_int(at[axis])));
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);  // complete
}

static inline float3 box_end(local const int* end) {
    return (float3)(as_float(ordered_bits(end[0])), as_float(ordered_bits(end[1])),
                    as_float(ordered_bits(end[2])));
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
        if (!lane_any(may_part(shaft, light, v))) return;
        walk->forms[atomic_inc(&walk->tested)][0].x = as_float(child);
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
            FV3 e = load_edge_points(points, k);
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

#if AREA_SHADOWS
// The same for a light with a size.
static inline bool shade_point_targets(ShadowScene scene, ShadowLight light,
                                       local const GroupWalk* walk, ShadowPoints* points) {
    LaneLight at = shared_light(light);
    MASK any = 1;
    for (uint j = 0; lane_any(any) && j < walk->tested; ++j) {
        uint child = as_uint(walk->forms[j][0].x);
        FV3 v[3];
        load_casters(scene, &child, v);
        any = 0;
#pragma unroll
        for (uint k = 0; k < SHADOW_POINTS; ++k) {
            if (k >= points->row_count) continue;  // the same for all items
            MASK lit = lit_of(points, k);
            ADD_COUNT(points, points, lane_count(lit));
            at.at = load_edge_points(points, k);
            lit &= ~hidden_by(v, child, scene, at, load_points(points, k), lit);
            points->lit[k] = as_float(lit);
            any |= lit;
        }
    }
    return lane_any(any);
}
#endif

// Tests what was found, GROUP triangles at a time.
static inline void test_found(ShadowScene scene, ShadowLight light, Shaft shaft, uint count,
                              local GroupWalk* walk, ShadowPoints* points) {
    ADD_COUNT(points, triangles, count);
    for (uint first = 0; first < count; first += GROUP) {
        if (this_item() == 0u) {
            walk->tested = 0u;
            walk->lit = 0u;
        }
        barrier(CLK_LOCAL_MEM_FENCE);  // 0 before any adds to it
        uint i = first + this_item();
        if (i < count) set_up_found(scene, light, shaft, walk->found[i], walk);
        barrier(CLK_LOCAL_MEM_FENCE);  // all are set up
#if AREA_SHADOWS
        bool lit = light.is_area ? shade_point_targets(scene, light, walk, points)
                                 : shade_points(scene, light, walk, points);
#else
        bool lit = shade_points(scene, light, walk, points);
#endif
        if (lit) walk->lit = 1u;
        barrier(CLK_LOCAL_MEM_FENCE);  // all have tested
    }
}

// How many of the `top` nodes on the stack are taken at once: so many that afterwards a walk that
// takes one at a time still has room, which needs SHADOW_WIDTH - 1 entries a level.
static inline uint nodes_to_take(ShadowView view, uint top) {
    uint levels = view.levels != 0u ? view.levels : SHADOW_LEVELS;
    uint room = SHADOW_STACK - 1u - levels * (SHADOW_WIDTH - 1u);
    uint take = min(top, (uint)NODES_AT_ONCE);
    return top + take * (SHADOW_WIDTH - 1u) <= room ? take : 1u;
}

// Takes `take` nodes off the stack, and puts those of their children that the shaft meets on the
// stack or into the found triangles.
static inline void walk_nodes(ShadowScene scene, Shaft shaft, uint top, uint take,
                              local GroupWalk* walk) {
    if (this_item() == 0u) walk->top = top - take;
    if (this_item() < take) walk->nodes[this_item()] = walk->stack[top - 1u - this_item()];
    barrier(CLK_LOCAL_MEM_FENCE);  // popped before any is pushed
    uint place = this_item() % SHADOW_WIDTH;
    uint mine = this_item() / SHADOW_WIDTH;
    global const ShadowNode* node = scene.nodes + (mine < take ? walk->nodes[mine] : 0u);
    if (mine < take && lane_any(meets_children(shaft, node, place))) {
        uint child = node->child[place];
        if ((child & SHADOW_LEAF) != 0u) {
            walk->found[atomic_inc(&walk->count)] = child;
        } else {
            walk->stack[atomic_inc(&walk->top)] = child;
        }
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

// One light's bits of one cluster, whose box is found.
static inline void cast_light(ShadowScene scene, ShadowLight light, uint first, uint end,
                              local GroupWalk* walk, ShadowPoints* points, global uint* words) {
    bool any = false;
    ulong tests_before = counted_tests(points);
    uint rays = 0, seen = 0;
#pragma unroll
    for (uint k = 0; k < SHADOW_POINTS; ++k) {
        if (k >= points->row_count) continue;
        uint place = place_of_point(first, k);
        MASK mine = lane_mask(place < end);
#if PICKED_ONLY
        mine &= lane_mask(place < end && (words[place / 32u - first / 32u] >> place % 32u & 1u));
#endif
        MASK lit = face_light(scene.view, points, k, light, mine);
        any |= lane_any(lit);
        rays += lane_count(lit);
    }
    barrier(CLK_LOCAL_MEM_FENCE);  // the last light is done
    if (this_item() == 0u) {
        walk->stack[0] = 0u;
        walk->top = 1u;
        walk->count = 0u;
        walk->lit = 0u;
    }
    barrier(CLK_LOCAL_MEM_FENCE);  // 0 before any item's points are lit
    if (any) walk->lit = 1u;
    cast_shadows_of_group(scene, light, make_shaft(light, box_end(walk->low), box_end(walk->high)),
                          walk, points);
#pragma unroll
    for (uint k = 0; k < SHADOW_POINTS; ++k) {
        uint place = place_of_point(first, k);
        if (place < end) walk->flags[place] = lane_any(lit_of(points, k));
        if (place < end) seen += lane_count(lit_of(points, k));
    }
    count_rays(points, tests_before, rays, seen);
    // All flags are set, and all have read the words.
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    store_words(first, end, walk, words);
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void cast_shadows(
    LIT_ARGS, SHADOW_ARGS, WORD_ARGS(), SAMPLE_ARGS,
    global ShadowCounts* restrict counts) {  // out [tiles * SPLIT] with COUNT_SHADOWS, where the
                                             // tile has lights
    local GroupWalk walk;
    uint tile = get_group_id(0) / SPLIT;
    if (word_offsets[tile] == word_offsets[tile + 1]) return;
    ShadowScene scene = SHADOW_SCENE_OF_ARGS;
    Clusters active = CLUSTERS_OF_ARGS;
    CastLights from = CAST_LIGHTS_OF_ARGS;
    uint key = key_of_tile(view, from, tile);
    ShadowPoints points;
    reset_counts(&points);
    FOR_EACH_CLUSTER(i, active, tile) {
        uint first = clusters[i].first_pixel;
        uint last = first + clusters[i].pixel_count;
        load_points_of_item(GBUFFER_OF_ARGS, origins, tile, order, first, last, &points);
        find_box(&points, &walk);
        global uint* out = words + word_offsets[tile] + clusters[i].first_word;
        uint count = shadow_words(first, last);
        for (uint j = get_group_id(0) % SPLIT; j < count_of_cluster(from, clusters + i);
             j += SPLIT) {
            ShadowLight light = light_of_cluster(from, shadow, clusters + i, j, key);
            global uint* slot_words = out + slots_before(from, j) * count;
            for (uint slot = 0; slot < slots_of(from, j);) {
#if PICKED_ONLY
                if (!any_word(slot_words + slot * count, count)) {  // the same for all items
                    slot = next_lobe(from, slot);
                    continue;
                }
#endif
                cast_light(scene, light_at_slot(from, light, slot), first, last, &walk, &points,
                           slot_words + slot * count);
                ++slot;
            }
        }
    }
#if COUNT_SHADOWS
    store_counts(&points, &walk, counts + get_group_id(0));
#endif
}
