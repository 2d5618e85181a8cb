// SPDX-License-Identifier: Apache-2.0
// Each active cluster's cut through the tree of the lights without a range, appended to its list.
//   cut_light_tree_count  entries of each list with its cut
//   (prefix_sum over clusters)
//   cut_light_tree_fill   the lists, and where they are
// One work-item takes VW clusters. They walk the tree together: a lane that is ahead waits.
#include "kernels/device/arguments.h"
#include "kernels/tails/tree_cut.h"

static inline Receivers load_receivers(global const ActiveCluster* clusters,
                                       global const ClusterCone* cones, uint first, uint count) {
    float middle[3][VW], radius[VW], axis[3][VW], cosine[VW], sine[VW], sharpness[VW];
    for (uint i = 0; i < VW; ++i) {
        uint cluster = first + min(i, count - 1u);
        ActiveCluster c = clusters[cluster];
        float3 half_edge = 0.5f * (float3)(c.max_x - c.min_x, c.max_y - c.min_y, c.max_z - c.min_z);
        middle[0][i] = 0.5f * (c.min_x + c.max_x);
        middle[1][i] = 0.5f * (c.min_y + c.max_y);
        middle[2][i] = 0.5f * (c.min_z + c.max_z);
        radius[i] = sqrt(dot(half_edge, half_edge));
        ClusterCone cone = cones[cluster];
        axis[0][i] = cone.axis_cosine.x;
        axis[1][i] = cone.axis_cosine.y;
        axis[2][i] = cone.axis_cosine.z;
        cosine[i] = cone.axis_cosine.w;
        sine[i] = cone.sine;
        sharpness[i] = cone.sharpness;
    }
    Receivers out;
    out.middle = fv3(lane_load(middle[0]), lane_load(middle[1]), lane_load(middle[2]));
    out.radius = lane_load(radius);
    out.axis = fv3(lane_load(axis[0]), lane_load(axis[1]), lane_load(axis[2]));
    out.cosine = lane_load(cosine);
    out.sine = lane_load(sine);
    out.sharpness = lane_load(sharpness);
    return out;
}

// The tree: nodes, and their lights among all.
typedef struct Tree {
    global const TreeNode* nodes;  // [count]
    global const float4* bounds;   // [count]: xyz: p_view
    uint count;
    float share;
} Tree;

// TreeCut of host/stages/tails/cut_light_tree.cpp. active_clusters: [1], may exceed the capacity;
// cones: [cluster_capacity].
#define CUT_ARGS(access)                                                \
    CLUSTER_ARGS(access), global const ulong *restrict active_clusters, \
        global const ClusterCone *restrict cones, LIGHT_ARGS(const), float share
#define TREE_OF_ARGS ((Tree){tree_nodes, bounds + light_count, node_count, share})

// One step of a walk of VW clusters: `next` is each lane's next node. Returns those that take
// `node`.
static inline MASK step_walk(Tree tree, Receivers r, uint node, UV* next) {
    TreeNode t = tree.nodes[node];
    MASK here = lane_mask(*next == (UV)(node));
    NodeChoice choice = choose_node(r, t, tree.bounds[node], tree.share);
    UV after = select((UV)(node + 1u), (UV)(t.next), lane_bits(choice.pass));
    *next = select(*next, after, lane_bits(here));
    return choice.take & here;
}

static inline UV start_walk(uint count, uint node_count) {
    return select((UV)(node_count), (UV)(0u), lane_bits(lane_mask(lane_numbers < (UV)(count))));
}

kernel void cut_light_tree_count(CUT_ARGS(const),
                                 global uint* restrict counts) {  // out [cluster_capacity]
    uint first = (uint)get_global_id(0) * VW;
    if (first >= cluster_capacity) return;
    uint active = (uint)min(*active_clusters, (ulong)cluster_capacity);
    uint end = min(first + VW, cluster_capacity);
    UV taken = (UV)(0u);
    uint count = first < active ? min(active - first, (uint)VW) : 0u;
    if (count > 0u) {
        Tree tree = TREE_OF_ARGS;
        Receivers r = load_receivers(clusters, cones, first, count);
        UV next = start_walk(count, node_count);
        for (uint node = 0; node < node_count; node = lane_min_uint(next)) {
            taken += lane_bits(step_walk(tree, r, node, &next)) & 1u;
        }
    }
    uint taken_by[VW];
    lane_store(taken, taken_by);
    for (uint i = first; i < end; ++i) {
        counts[i] = i < active ? clusters[i].list_count + taken_by[i - first] : 0u;
    }
}

// Copies the list of a cluster to its new place; returns how many entries there was room for.
static inline uint copy_list(global const LIGHT_INDEX* from, uint count, global LIGHT_INDEX* lists,
                             uint begin, uint capacity) {
    uint room = begin < capacity ? capacity - begin : 0u;
    uint copied = min(count, room);
    for (uint i = 0; i < copied; ++i) lists[begin + i] = from[i];
    return copied;
}

kernel void cut_light_tree_fill(CUT_ARGS(),  // in/out: the clusters' lists set
                                global const LIGHT_INDEX* restrict refined,  // the lists until then
                                global const uint* restrict offsets,  // [cluster_capacity + 1]
                                LIST_ARGS()) {
    uint first = (uint)get_global_id(0) * VW;
    uint active = (uint)min(*active_clusters, (ulong)cluster_capacity);
    if (first >= active) return;
    uint count = min(active - first, (uint)VW);
    uint place[VW];
    for (uint i = 0; i < count; ++i) {
        ActiveCluster c = clusters[first + i];
        uint begin = min(offsets[first + i], list_capacity);
        place[i] =
            begin + copy_list(refined + c.list_begin, c.list_count, lists, begin, list_capacity);
    }
    Tree tree = TREE_OF_ARGS;
    Receivers r = load_receivers(clusters, cones, first, count);
    UV next = start_walk(count, node_count);
    for (uint node = 0; node < node_count; node = lane_min_uint(next)) {
        uint takers = lane_ballot(step_walk(tree, r, node, &next));
        for (uint i = 0; takers != 0u; ++i, takers >>= 1) {
            if ((takers & 1u) == 0u || place[i] >= list_capacity) continue;
            lists[place[i]++] = (LIGHT_INDEX)(light_count + node);
        }
    }
    for (uint i = 0; i < count; ++i) {
        uint begin = min(offsets[first + i], list_capacity);
        clusters[first + i].list_begin = begin;
        clusters[first + i].list_count = place[i] - begin;
    }
}
