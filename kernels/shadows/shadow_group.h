// SPDX-License-Identifier: Apache-2.0
// The common part of what a work-group of GROUP items does in cast_shadows_by_group.cl: its shared
// memory, the points of a cluster, boxes that it grows together, and its walk through the
// hierarchy.
#ifndef KILOLUX_DEVICE_SHADOW_GROUP_H
#define KILOLUX_DEVICE_SHADOW_GROUP_H
#include "kernels/shadows/cast_shadows.h"
#include "kernels/shadows/shadow_cast.h"

#define NODES_AT_ONCE (GROUP / SHADOW_WIDTH)
// Most triangles that wait for their test.
#define GROUP_FOUND (2 * GROUP)
// float4 of a triangle: its forms and the edges' units with its child's number; or, of a light with
// a size, its corners with the number, and its box.
#define FORM_FLOAT4S 5
// Most rays of a walk to a light with a size, and most pairs of them and triangles that wait for
// their test.
#define GROUP_RAYS 128u
#define GROUP_PAIRS (4u * GROUP)
#if GROUP % 32 != 0 || GROUP > 512
#error "GROUP must be a multiple of 32, and at most 512: GroupRays numbers pairs by 16 bits"
#endif
// Words of a slot at most: a tile's pixels and the places beside them.
#define GROUP_WORDS 16u

// A box that items grow together, as ordered_bits.
typedef struct GroupBox {
    int low[3], high[3];
} GroupBox;

#if AREA_SHADOWS
// Rays to a light with a size.
typedef struct GroupRays {
    float4 origins[GROUP_RAYS], targets[GROUP_RAYS];  // xyz [m]
    uint bits[GROUP_RAYS];      // number of the word among the light's times 32, and of the bit
    uint lit[GROUP_RAYS];       // 1 while nothing is found to hide the target
    ushort pairs[GROUP_PAIRS];  // number of a triangle times GROUP_RAYS, and of the ray
    uint pair_count[2];         // of every second round
    uint count;                 // may exceed GROUP_RAYS
    uint any_left;              // 1 where it does
    GroupBox targets_box;
} GroupRays;
#endif

// The memory that the items share. Groups of 128 with area lights and COUNT_SHADOWS leave 300 bytes
// of the 32 KiB that OpenCL promises.
typedef struct GroupWalk {
    uint stack[SHADOW_STACK];
    uint found[GROUP_FOUND];
    float4 forms[GROUP][FORM_FLOAT4S];  // of the triangles that are tested
    uint pushed[2];                     // onto the stack; steps use the two in turn
    uint count;                         // of found
    uint tested;                        // triangles
    uint masked[GROUP / 32];            // bit i: triangle i of them may have holes
    uint lit;                           // 1 while any point or ray is
    uint picked;                        // bits of lights
    // The cluster's points by their places in the tile's order: positions [m] and packed normals.
    float x[FINE_TILE_PIXELS], y[FINE_TILE_PIXELS], z[FINE_TILE_PIXELS];
    float normal[FINE_TILE_PIXELS];
    // A byte for each place, 1 where lit; four to a uint.
    uint flags[FINE_TILE_PIXELS / 4];
    // Places of the points that face the light, in any order, and their number.
    uchar places[FINE_TILE_PIXELS];
    uint faced;
#if COUNT_SHADOWS
    ShadowCounts counts[GROUP];  // of the items: nodes, triangles and shafts by each for all
#endif
    GroupBox box;  // of the points that face the light
    Shaft shaft;   // of the walk; in registers it would let fewer groups run at once
#if AREA_SHADOWS
    GroupRays rays;
#endif
} GroupWalk;

// The lights of one cluster and where their bits are.
typedef struct ClusterCast {
    ShadowScene scene;
    CastLights from;
    global const ActiveCluster* cluster;
    uint key;            // of the tile
    uint first, end;     // the cluster's pixels are first .. end - 1 in the tile's order
    uint count;          // words of each slot
    global uint* words;  // of the cluster
    uint words_begin;    // of the cluster, among those of all tiles
    global const uint* kept;
    uint split;  // the group takes every split-th light
} ClusterCast;

static inline uint this_item(void) { return get_local_id(0); }

// Floats' order, negative ones included, as integers'; its own inverse on bits.
static inline int ordered_bits(int bits) { return bits ^ (bits >> 31 & 0x7fffffff); }

// Item 0 .. 2 empties a box.
static inline void empty_box(local GroupBox* box) {
    if (this_item() >= 3u) return;
    box->low[this_item()] = ordered_bits(as_int(SHADOW_NOWHERE));
    box->high[this_item()] = ordered_bits(as_int(-SHADOW_NOWHERE));
}

static inline void grow_box(local GroupBox* box, LaneBox by) {
    const float low[3] = {by.low.x, by.low.y, by.low.z};
    const float high[3] = {by.high.x, by.high.y, by.high.z};
#pragma unroll
    for (uint axis = 0; axis < 3; ++axis) {
        atomic_min(&box->low[axis], ordered_bits(as_int(low[axis])));
        atomic_max(&box->high[axis], ordered_bits(as_int(high[axis])));
    }
}

static inline float3 box_end(local const int* end) {
    return (float3)(as_float(ordered_bits(end[0])), as_float(ordered_bits(end[1])),
                    as_float(ordered_bits(end[2])));
}

// The points of a cluster, for the items to share. No item still reads the last cluster's:
// cast_light() has a barrier after its tests.
static inline void share_points(View view, global const float* origins, uint tile,
                                global const uchar* order, uint first, uint end,
                                local GroupWalk* walk) {
    uint plane = view.stride * view.height;
    for (uint place = first + this_item(); place < end; place += GROUP) {
        Pixels pixels = pixels_of_tile(view, tile, place, order);
        walk->x[place] = LOAD_PLANE(FV, origins + ORIGIN_X * plane, pixels);
        walk->y[place] = LOAD_PLANE(FV, origins + ORIGIN_Y * plane, pixels);
        walk->z[place] = LOAD_PLANE(FV, origins + ORIGIN_Z * plane, pixels);
        walk->normal[place] = LOAD_PLANE(FV, origins + ORIGIN_NORMAL * plane, pixels);
    }
}

static inline FV3 point_at(local const GroupWalk* walk, uint place) {
    return fv3(walk->x[place], walk->y[place], walk->z[place]);
}

// The i-th of the points that face the light; the last one, where there are fewer.
static inline FV3 faced_point(local const GroupWalk* walk, uint i) {
    return point_at(walk, walk->places[min(i, walk->faced - 1u)]);
}

static inline global uint* words_of_light(ClusterCast cast, uint j) {
    return cast.words + slots_before(cast.from, j) * cast.count;
}

static inline ShadowLight light_of_cast(ClusterCast cast, uint j) {
    return light_of_cluster(cast.from, cast.scene.view, cast.cluster, j, cast.key);
}

#if PICKED_ONLY
// Which of the cluster's lights first, first + split, ..., 32 of them at most, any pixel picks.
static inline uint find_wanted(ClusterCast cast, uint first, local GroupWalk* walk) {
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);  // the last ones are done
    if (this_item() == 0u) walk->picked = 0u;
    barrier(CLK_LOCAL_MEM_FENCE);  // 0 before any adds to it
    uint word = this_item() % GROUP_WORDS;
    for (uint k = this_item() / GROUP_WORDS; k < 32u; k += GROUP / GROUP_WORDS) {
        uint j = first + k * cast.split;
        if (j >= count_of_cluster(cast.from, cast.cluster)) break;
        if (word >= cast.count) continue;
        uint bits = picked_bits(cast.from, j, words_of_light(cast, j) + word, cast.count);
        if (bits != 0u) atomic_or(&walk->picked, 1u << k);
    }
    barrier(CLK_LOCAL_MEM_FENCE);  // complete
    return walk->picked;
}
#else
// Which of the cluster's lights first, first + split, ..., 32 of them at most, are not kept.
static inline uint find_wanted(ClusterCast cast, uint first, local GroupWalk* walk) {
    uint left = count_of_cluster(cast.from, cast.cluster) - first;
    uint count = min((left + cast.split - 1u) / cast.split, 32u);
    uint wanted = 0xffffffffu >> (32u - count);
    if (cast.kept == 0) return wanted;
    for (uint k = 0; k < count; ++k) {
        uint word = cast.words_begin + (first + k * cast.split) * cast.count;
        if (is_kept(cast.kept, word)) wanted &= ~(1u << k);
    }
    return wanted;
}
#endif

// Starts a walk at the root, for no points: `lit` is 0 until an item sets it.
static inline void begin_walk(local GroupWalk* walk) {
    if (this_item() != 0u) return;
    walk->stack[0] = 0u;
    walk->pushed[0] = 0u;
    walk->pushed[1] = 0u;
    walk->count = 0u;
    walk->lit = 0u;
    walk->faced = 0u;
}

// An item's copy of the stack's state, the same in all items: `base` entries, and above them those
// that the last step pushed, walk->pushed[side] of them. There are two counters, so that one is
// read while the other is emptied.
typedef struct GroupStack {
    uint base, side;
} GroupStack;

static inline uint stack_top(const GroupStack* stack, local const GroupWalk* walk) {
    return stack->base + walk->pushed[stack->side];
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
static inline void walk_nodes(ShadowScene scene, uint top, uint take, GroupStack* stack,
                              local GroupWalk* walk) {
    uint place = this_item() % SHADOW_WIDTH;
    uint mine = this_item() / SHADOW_WIDTH;
    global const ShadowNode* node = scene.nodes + (mine < take ? walk->stack[top - 1u - mine] : 0u);
    uint child = node->child[place];  // loaded with the boxes, before it is known to be needed
    bool meets = mine < take && lane_any(meets_children(walk->shaft, node, place));
    barrier(CLK_LOCAL_MEM_FENCE);  // stack and counters are read by all before they change
    if (this_item() == 0u) walk->pushed[stack->side] = 0u;
    stack->side ^= 1u;
    stack->base = top - take;
    if (!meets) return;
    if ((child & SHADOW_LEAF) != 0u) {
        walk->found[atomic_inc(&walk->count)] = child;
    } else {
        walk->stack[stack->base + atomic_inc(&walk->pushed[stack->side])] = child;
    }
}
#endif
