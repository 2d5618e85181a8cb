// SPDX-License-Identifier: Apache-2.0
// The totals of a frame's lists, as one PairCounts that the host reads at once.
//   count_pairs_sum_shares  each work-group of GROUP sums a share of the active clusters
//   count_pairs             one work-group joins the shares and the lists' totals
// All sums are of integers: the same in any order.
#include "kernels/device/arguments.h"

#ifndef GROUP
#define GROUP 1
#endif

// The sum of the work-group's items, for item 0. All items must come here.
static inline ulong4 sum_of_group(ulong4 mine, local ulong4* of_items) {
    of_items[get_local_id(0)] = mine;
    barrier(CLK_LOCAL_MEM_FENCE);  // every item's sum is there
    ulong4 sum = (ulong4)(0ul);
    for (uint i = 0; get_local_id(0) == 0 && i < GROUP; ++i) sum += of_items[i];
    return sum;
}

// Sums over active clusters: x: list_count, y: pixel_count, z: their products.
kernel void count_pairs_sum_shares(
    CLUSTER_ARGS(const),
    global const ulong* restrict active_clusters,  // [1]: may exceed the capacity
    global ulong4* restrict shares) {              // out [work-groups]
    local ulong4 of_items[GROUP];
    uint count = (uint)min(*active_clusters, (ulong)cluster_capacity);
    ulong4 sums = (ulong4)(0ul);
    for (size_t i = get_global_id(0); i < count; i += get_global_size(0)) {
        ulong lights = clusters[i].list_count, pixels = clusters[i].pixel_count;
        sums += (ulong4)(lights, pixels, lights * pixels, 0ul);
    }
    sums = sum_of_group(sums, of_items);
    if (get_local_id(0) == 0) shares[get_group_id(0)] = sums;
}

kernel void count_pairs(global const ulong* restrict coarse_pairs,     // [1]
                        global const ulong* restrict active_clusters,  // [1]
                        global const ulong* restrict refine_tests,     // [1]
                        global const ulong4* restrict shares,          // [share_count]
                        uint share_count,
                        global PairCounts* restrict counts) {  // out [1]
    local ulong4 of_items[GROUP];
    ulong4 sums = (ulong4)(0ul);
    for (uint i = get_local_id(0); i < share_count; i += GROUP) sums += shares[i];
    sums = sum_of_group(sums, of_items);
    if (get_local_id(0) == 0) {
        counts->coarse_pairs = *coarse_pairs;
        counts->active_clusters = *active_clusters;
        counts->refine_tests = *refine_tests;
        counts->refined_pairs = sums.x;
        counts->surface_pixels = sums.y;
        counts->evaluations = sums.z;
    }
}
