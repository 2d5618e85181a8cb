// SPDX-License-Identifier: Apache-2.0
// Sums over the values of a work-group's items. GROUP: their number.
#ifndef KILOLUX_DEVICE_SCAN_GROUP_H
#define KILOLUX_DEVICE_SCAN_GROUP_H

// Exclusive scan of one value a work-item. `shared_sums`, [GROUP]: out, the inclusive sums.
static inline ulong scan_group(ulong value, local ulong* shared_sums) {
#if GROUP == 1
    return 0ul;
#else
    uint item = get_local_id(0);
    shared_sums[item] = value;
    barrier(CLK_LOCAL_MEM_FENCE);  // every value is there before any is read
    for (uint step = 1; step < GROUP; step <<= 1) {
        ulong other = item >= step ? shared_sums[item - step] : 0ul;
        barrier(CLK_LOCAL_MEM_FENCE);  // all have read before any writes
        shared_sums[item] += other;
        barrier(CLK_LOCAL_MEM_FENCE);  // all have written before the next round reads
    }
    return shared_sums[item] - value;
#endif
}

// Sum of one value a work-item. `shared_sums`, [GROUP]: free for other use afterwards.
static inline ulong sum_group(ulong value, local ulong* shared_sums) {
#if GROUP == 1
    return value;
#else
    scan_group(value, shared_sums);
    ulong sum = shared_sums[GROUP - 1];
    barrier(CLK_LOCAL_MEM_FENCE);  // all have read before any writes
    return sum;
#endif
}
#endif
