// SPDX-License-Identifier: Apache-2.0
// Exclusive prefix sum of uint counts. A work-group sums a block. Few blocks take one launch:
//   prefix_sum_few      each work-group also sums all blocks before its own
// more take three:
//   prefix_sum_blocks   each work-item sums its PER_ITEM neighbours, each work-group its block
//   prefix_sum_totals   one work-item scans the blocks' sums, in 64 bits
//   prefix_sum_apply    each work-item writes its neighbours' offsets
// GROUP is the work-group size, PER_ITEM the elements a work-item takes; GROUP * PER_ITEM is a
// block.
#ifndef GROUP
#define GROUP 1
#endif
#ifndef PER_ITEM
#define PER_ITEM 1024
#endif
#include "kernels/device/scan_group.h"

static inline ulong sum_of_item(global const uint* counts, uint n, uint first) {
    ulong sum = 0;
    for (uint i = first; i < min(first + PER_ITEM, n); ++i) sum += counts[i];
    return sum;
}

// Offsets of an item's neighbours, the first of which is `sum`; modulo 2^32: the host refuses
// larger lists by the exact total.
static inline void write_offsets(global const uint* counts, uint n, uint first, uint sum,
                                 global uint* offsets) {
    for (uint i = first; i < min(first + PER_ITEM, n); ++i) {
        uint value = counts[i];
        offsets[i] = sum;
        sum += value;
    }
}

// Sum over the blocks before the work-group's. Neighbouring items load neighbouring counts.
static inline ulong sum_before(global const uint* counts, local ulong* shared_sums) {
    uint loads = (uint)get_group_id(0) * PER_ITEM;
    global const uint* place = counts + get_local_id(0);
    ulong sum = 0;
    // Loads that do not wait for each other: memory's latency decides.
#pragma unroll 8
    for (uint i = 0; i < loads; ++i) sum += place[(size_t)i * GROUP];
    return sum_group(sum, shared_sums);
}

kernel void prefix_sum_few(global const uint* restrict counts,  // [n]
                           uint n,
                           global uint* restrict offsets,   // out [n + 1]; offsets[n] = total,
                                                            // modulo 2^32
                           global ulong* restrict total) {  // out [1]: the exact total
    local ulong shared_sums[GROUP];
    ulong blocks = sum_before(counts, shared_sums);
    uint first = (uint)get_global_id(0) * PER_ITEM;
    ulong sum = sum_of_item(counts, n, first);
    ulong before = blocks + scan_group(sum, shared_sums);
    write_offsets(counts, n, first, (uint)before, offsets);
    if (get_global_id(0) == get_global_size(0) - 1) {
        offsets[n] = (uint)(before + sum);
        *total = before + sum;
    }
}

kernel void prefix_sum_blocks(global const uint* restrict counts,  // [n]
                              uint n,
                              global ulong* restrict block_sums) {  // out [groups]
    local ulong shared_sums[GROUP];
    ulong sum = sum_of_item(counts, n, (uint)get_global_id(0) * PER_ITEM);
    ulong before = scan_group(sum, shared_sums);
    if (get_local_id(0) == GROUP - 1) block_sums[get_group_id(0)] = before + sum;
}

kernel void prefix_sum_totals(
    global ulong* restrict block_sums,  // in: sums, out: offsets [block_count]
    uint block_count, uint n,
    global uint* restrict offsets,   // out: offsets[n] = total, modulo 2^32
    global ulong* restrict total) {  // out [1]: the exact total
    ulong sum = 0;
    for (uint block = 0; block < block_count; ++block) {
        ulong value = block_sums[block];
        block_sums[block] = sum;
        sum += value;
    }
    offsets[n] = (uint)sum;
    *total = sum;
}

kernel void prefix_sum_apply(
    global const uint* restrict counts,  // [n]
    uint n,
    global const ulong* restrict block_sums,  // [groups], offsets
    global uint* restrict offsets) {          // out [n + 1]; the last by prefix_sum_totals
    local ulong shared_sums[GROUP];
    uint first = (uint)get_global_id(0) * PER_ITEM;
    ulong before =
        block_sums[get_group_id(0)] + scan_group(sum_of_item(counts, n, first), shared_sums);
    write_offsets(counts, n, first, (uint)before, offsets);
}
