// SPDX-License-Identifier: Apache-2.0
// What the lists of a frame hold, as one PairCounts that the host reads at once.
//   count_pairs_sum_shares  each work-item sums every get_global_size(0)-th active cluster
//   count_pairs             one work-group of GROUP joins the shares and the lists' totals
// All sums are of integers: the same in any order.
#include "kernels/shared/clusters.h"

#ifndef GROUP
#define GROUP 1
#endif

// Sums over active clusters.
typedef struct ClusterSums {
    ulong refined_pairs, drawn_pixels, evaluations;
} ClusterSums;

static inline ClusterSums added(ClusterSums a, ClusterSums b) {
    a.refined_pairs += b.refined_pairs;
    a.drawn_pixels += b.drawn_pixels;
    a.evaluations += b.evaluations;
    return a;
}

static inline ClusterSums no_sums(void) {
    ClusterSums sums;
    sums.refined_pairs = 0;
    sums.drawn_pixels = 0;
    sums.evaluations = 0;
    return sums;
}

kernel void count_pairs_sum_shares(
    global const ActiveCluster* restrict clusters,  // [capacity]
    uint capacity,
    global const ulong* restrict active_clusters,  // [1]: may exceed the capacity
    global ClusterSums* restrict shares) {         // out [work-items]
    uint count = (uint)min(*active_clusters, (ulong)capacity);
    ClusterSums sums = no_sums();
    for (size_t i = get_global_id(0); i < count; i += get_global_size(0)) {
        ClusterSums cluster;
        cluster.refined_pairs = clusters[i].list_count;
        cluster.drawn_pixels = clusters[i].pixel_count;
        cluster.evaluations = cluster.refined_pairs * cluster.drawn_pixels;
        sums = added(sums, cluster);
    }
    shares[get_global_id(0)] = sums;
}

kernel void count_pairs(global const ulong* restrict coarse_pairs,     // [1]
                        global const ulong* restrict active_clusters,  // [1]
                        global const ulong* restrict refine_tests,     // [1]
                        global const ClusterSums* restrict shares,     // [share_count]
                        uint share_count,
                        global PairCounts* restrict counts) {  // out [1]
    local ClusterSums sums_of_items[GROUP];
    ClusterSums sums = no_sums();
    for (uint i = get_local_id(0); i < share_count; i += GROUP) sums = added(sums, shares[i]);
    sums_of_items[get_local_id(0)] = sums;
    barrier(CLK_LOCAL_MEM_FENCE);  // every item's sum is there
    if (get_local_id(0) == 0) {
        for (uint i = 1; i < GROUP; ++i) sums = added(sums, sums_of_items[i]);
        counts->coarse_pairs = *coarse_pairs;
        counts->active_clusters = *active_clusters;
        counts->refine_tests = *refine_tests;
        counts->refined_pairs = sums.refined_pairs;
        counts->drawn_pixels = sums.drawn_pixels;
        counts->evaluations = sums.evaluations;
    }
}
