// SPDX-License-Identifier: Apache-2.0
// The totals of a frame's lists, as one PairCounts that the host reads at once.
//   count_pairs_sum_shares  each work-item sums every get_global_size(0)-th active cluster
//   count_pairs             one work-group of GROUP joins the shares and the lists' totals
// All sums are of integers: the same in any order.
#include "kernels/device/arguments.h"

#ifndef GROUP
#define GROUP 1
#endif

// Sums over active clusters: x: list_count, y: pixel_count, z: their products.
kernel void count_pairs_sum_shares(
    CLUSTER_ARGS(const),
    global const ulong* restrict active_clusters,  // [1]: may exceed the capacity
    global ulong4* restrict shares) {              // out [work-items]
    uint count = (uint)min(*active_clusters, (ulong)cluster_capacity);
    ulong lists = 0, pixels = 0, evaluations = 0;
    for (size_t i = get_global_id(0); i < count; i += get_global_size(0)) {
        ulong lights = clusters[i].list_count;
        lists += lights;
        pixels += clusters[i].pixel_count;
        evaluations += lights * clusters[i].pixel_count;
    }
    shares[get_global_id(0)] = (ulong4)(lists, pixels, evaluations, 0ul);
}

kernel void count_pairs(global const ulong* restrict coarse_pairs,     // [1]
                        global const ulong* restrict active_clusters,  // [1]
                        global const ulong* restrict refine_tests,     // [1]
                        global const ulong4* restrict shares,          // [share_count]
                        uint share_count,
                        global PairCounts* restrict counts) {  // out [1]
    local ulong4 sums_of_items[GROUP];
    ulong4 sums = (ulong4)(0ul);
    for (uint i = get_local_id(0); i < share_count; i += GROUP) sums += shares[i];
    sums_of_items[get_local_id(0)] = sums;
    barrier(CLK_LOCAL_MEM_FENCE);  // every item's sum is there
    if (get_local_id(0) == 0) {
        for (uint i = 1; i < GROUP; ++i) sums += sums_of_items[i];
        counts->coarse_pairs = *coarse_pairs;
        counts->active_clusters = *active_clusters;
        counts->refine_tests = *refine_tests;
        counts->refined_pairs = sums.x;
        counts->surface_pixels = sums.y;
        counts->evaluations = sums.z;
    }
}
