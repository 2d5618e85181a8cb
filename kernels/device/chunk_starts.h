// SPDX-License-Identifier: Apache-2.0
// Counts by (chunk, bin) -> the start of each chunk's entries within each bin: a counting sort's
// step between counting and the prefix sum over bins.
#ifndef KILOLUX_DEVICE_CHUNK_STARTS_H
#define KILOLUX_DEVICE_CHUNK_STARTS_H
#include "kernels/device/lanes.h"

#define CHUNKS_AT_ONCE 16

// Cursors from one chunk to the next: as many vectors as hold its bins.
static inline uint cursor_stride(uint bin_count) { return (bin_count + VW - 1u) / VW * VW; }

// Of the VW bins from `bin` on: cursors[chunk][bin] become starts, counts[bin] the bin's entries.
// CHUNKS_AT_ONCE chunks are loaded before any of them is stored. Otherwise each load would wait for
// the store before it, which might be to the same address, and every chunk would pay memory's
// latency.
static inline void chunk_starts(global uint* cursors, uint bin_count, uint chunk_count, uint bin,
                                global uint* counts) {
    uint stride = cursor_stride(bin_count);
    global uint* place = cursors + bin;
    UV sum = (UV)(0u);
    for (uint chunk = 0; chunk < chunk_count; chunk += CHUNKS_AT_ONCE) {
        uint here = min(chunk_count - chunk, (uint)CHUNKS_AT_ONCE);
        UV entries[CHUNKS_AT_ONCE];
#pragma unroll
        for (uint i = 0; i < CHUNKS_AT_ONCE; ++i) {
            if (i < here) entries[i] = lane_load(place + i * stride);
        }
#pragma unroll
        for (uint i = 0; i < CHUNKS_AT_ONCE; ++i) {
            if (i < here) {
                lane_store(sum, place + i * stride);
                sum += entries[i];
            }
        }
        place += CHUNKS_AT_ONCE * stride;
    }
    lane_store(sum, counts + bin);
}
#endif
