// SPDX-License-Identifier: Apache-2.0
// The coarse list of each active cluster, refined against the box of its pixels.
//   refine_lights_reserve  entries that each tile's coarse lists could need
//   (prefix_sum over tiles)
//   refine_lights          the lists, ascending, one after the other within the tile's reserve
// One work-group takes one tile; its GROUP work-items test VW lights each at a time.
#include "kernels/device/lit_item.h"
#include "kernels/lists/coarse_tile.h"
#include "kernels/lists/light_reach.h"

#ifndef GROUP
#define GROUP 1
#endif
#define BATCH (GROUP * VW)

// The coarse cluster that holds a fine tile's fine slice.
static inline uint coarse_cluster(View view, ClusterGrid grid, uint tile, uint slice) {
    CoarseTile coarse = coarse_tile(view, grid, tile);
    return cluster_index(grid, coarse.column, coarse.row, slice >> grid.fine_slice_bits);
}

kernel void refine_lights_reserve(View view, CLUSTER_ARGS(const), uint tile_count,
                                  COARSE_LIST_ARGS(const),
                                  global uint* restrict reserves) {  // out [tile_count]
    uint tile = get_global_id(0);
    if (tile >= tile_count) return;
    Clusters active = CLUSTERS_OF_ARGS;
    // Saturates: the prefix sum's total then says that 32-bit offsets do not suffice.
    ulong sum = 0;
    // More clusters than there is room for: the host grows the buffer and runs the stage again.
    FOR_EACH_CLUSTER(i, active, tile) {
        uint coarse = coarse_cluster(view, grid, tile, clusters[i].slice);
        sum += coarse_offsets[coarse + 1] - coarse_offsets[coarse];
    }
    reserves[tile] = (uint)min(sum, (ulong)0xffffffffu);
}

// VW neighbours of a coarse list, or the rest of it; lanes beyond the end repeat the last entry.
typedef struct Batch {
    uint count;
    uint light[VW];
} Batch;

// Loads entries from `first` on of the list that ends before `end`.
static inline void load_batch(global const LIGHT_INDEX* list, uint first, uint end, Batch* out) {
    out->count = first < end ? min(end - first, (uint)VW) : 0u;
    if (out->count == VW) {
        lane_store(KX_CONCAT(convert_, UV)(lane_load(list + first)), out->light);
    } else if (out->count > 0u) {
        for (uint i = 0; i < VW; ++i) out->light[i] = list[first + min(i, out->count - 1u)];
    }
}

// One component of VW bounds.
#define COMPONENT_OF(i, component, bound) (bound)[i].component
#define BOUNDS(component, bound) LANES(FV, COMPONENT_OF, component, bound)

// Which of a batch's lights reach the cluster's box; 1 or 0.
static inline UV reaching_lanes(ActiveCluster c, global const ShadeLight* lights,
                                global const float4* bounds, const Batch* batch) {
    // Copied in registers: a vector that is read where its lanes have just been written one by one
    // waits until all of them have reached the cache.
    float4 bound[VW];
#pragma unroll
    for (uint i = 0; i < VW; ++i) bound[i] = bounds[batch->light[i]];
    FV x = BOUNDS(x, bound), y = BOUNDS(y, bound), z = BOUNDS(z, bound);
    FV dx = max(max(c.min_x - x, x - c.max_x), fv(0.0f));
    FV dy = max(max(c.min_y - y, y - c.max_y), fv(0.0f));
    FV dz = max(max(c.min_z - z, z - c.max_z), fv(0.0f));
    FV in_ranges2 = fma(dz, dz, fma(dy, dy, dx * dx)) * BOUNDS(w, bound);
    MASK reach = lane_mask(in_ranges2 <= fv(CULL_LIMIT));
    if (batch->count < VW) reach = reach & lane_mask(lane_numbers < (UV)(batch->count));
    UV flags = lane_bits(reach) & 1u;
#if HAS_SPOT_LIGHTS
    uint flag[VW];
    lane_store(flags, flag);
    for (uint i = 0; i < VW; ++i) {
        if (flag[i] && !cone_reaches(lights[batch->light[i]], (float3)(c.min_x, c.min_y, c.min_z),
                                     (float3)(c.max_x, c.max_y, c.max_z))) {
            flag[i] = 0;
        }
    }
    flags = lane_load(flag);
#endif
    return flags;
}

// Appends the flagged lights in order and returns how many there were in the whole work-group.
static inline uint append(UV flags, const Batch* batch, global LIGHT_INDEX* out, uint room,
                          local uint* ballots) {
    uint flag[VW];
    lane_store(flags, flag);
#if GROUP == 1
    uint count = 0;
    if (batch->count == VW && VW <= room) {
        // A branch could not be predicted, so each light is written, and the next one overwrites it
        // if it does not reach. The reserve has room for all.
#pragma unroll
        for (uint i = 0; i < VW; ++i) {
            out[count] = (LIGHT_INDEX)batch->light[i];
            count += flag[i];
        }
        return count;
    }
    for (uint i = 0; i < VW; ++i) {
        if (flag[i] && count < room) out[count] = (LIGHT_INDEX)batch->light[i];
        count += flag[i];
    }
    return count;
#else
    // Rank of a light: set flags of the batch before it, from ballots of 32 in local memory.
    uint item = get_local_id(0);
    if (item < (BATCH + 31) / 32) ballots[item] = 0;
    barrier(CLK_LOCAL_MEM_FENCE);  // cleared before any bit is set
    for (uint i = 0; i < VW; ++i) {
        uint bit = item * VW + i;
        if (flag[i]) atomic_or(&ballots[bit / 32], 1u << (bit % 32));
    }
    barrier(CLK_LOCAL_MEM_FENCE);  // all bits are set before any is counted
    uint total = 0;
    uint before = 0;
    for (uint word = 0; word < (BATCH + 31) / 32; ++word) {
        uint bits = ballots[word];
        uint bit = item * VW;
        before += word < bit / 32    ? popcount(bits)
                  : word == bit / 32 ? popcount(bits & ((1u << (bit % 32)) - 1u))
                                     : 0u;
        total += popcount(bits);
    }
    for (uint i = 0; i < VW; ++i) {
        if (flag[i] && before < room) out[before] = (LIGHT_INDEX)batch->light[i];
        before += flag[i];
    }
    barrier(CLK_LOCAL_MEM_FENCE);  // ballots are counted before the next batch clears them
    return total;
#endif
}

kernel void refine_lights(LIGHT_ARGS(const), View view, COARSE_LIST_ARGS(const),
                          CLUSTER_ARGS(),  // in/out: the clusters' lists set
                          global const uint* restrict list_offsets,  // [tiles + 1], reserves
                          LIST_ARGS()) {
    local uint ballots[(BATCH + 31) / 32];
    uint tile = get_group_id(0);
    uint place = list_offsets[tile];
    Clusters active = CLUSTERS_OF_ARGS;
    FOR_EACH_CLUSTER(i, active, tile) {
        ActiveCluster c = clusters[i];
        uint coarse = coarse_cluster(view, grid, tile, c.slice);
        uint coarse_begin = coarse_offsets[coarse];
        uint coarse_end = min(coarse_offsets[coarse + 1], coarse_capacity);
        uint begin = place;
        for (uint first = coarse_begin; first < coarse_end; first += BATCH) {
            uint mine = first + (uint)get_local_id(0) * VW;
            Batch batch;
            load_batch(coarse_lists, mine, coarse_end, &batch);
            UV flags = (UV)(0u);
            if (batch.count > 0u) flags = reaching_lanes(c, lights, bounds, &batch);
            uint room = place < list_capacity ? list_capacity - place : 0u;
            place += append(flags, &batch, lists + place, room, ballots);
        }
#if GROUP > 1
        barrier(CLK_GLOBAL_MEM_FENCE);  // all have read the cluster before its list is set
#endif
        if (get_local_id(0) == 0) {
            clusters[i].list_begin = min(begin, list_capacity);
            clusters[i].list_count = min(place, list_capacity) - min(begin, list_capacity);
        }
    }
}
