// SPDX-License-Identifier: Apache-2.0
// The coarse list of each active cluster, refined against the box of its pixels.
//   refine_lights_reserve  entries that each tile's coarse lists could need
//   (prefix_sum over tiles)
//   refine_lights_blocks   (BLOCK > 0) the boxes of BLOCK neighbours of a coarse list each
//   refine_lights          the lists, ascending, one after the other within the tile's reserve
// One work-group takes one tile; its GROUP work-items test VW lights each at a time. With BLOCK >
// 0, for long lists, only the lights of blocks that can reach the cluster: neighbours in a list are
// neighbours in space (light_order.h). The lists are the same.
#include "kernels/device/group_ballot.h"
#include "kernels/device/lit_item.h"
#include "kernels/lists/coarse_tile.h"
#include "kernels/lists/light_reach.h"

#ifndef GROUP
#define GROUP 1
#endif
#define BATCH (GROUP * VW)
// Work-items that share a block, each with neighbours of it, which it loads at once.
#define BLOCK_ITEMS (GROUP % 4 == 0 ? 4u : 1u)
#ifndef BLOCK
#define BLOCK 0
#endif

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

// The list of a coarse cluster.
typedef struct CoarseList {
    uint begin, end;  // of its entries
    uint block;       // its first one
} CoarseList;

static inline CoarseList coarse_list(global const uint* offsets, uint capacity, uint coarse) {
    CoarseList list;
    list.end = min(offsets[coarse + 1], capacity);
    list.begin = min(offsets[coarse], list.end);
#if BLOCK > 0
    list.block = list.begin / BLOCK + coarse;  // so that no two lists share one
#endif
    return list;
}

#if BLOCK > 0
static inline uint blocks_of(CoarseList list) {
    return (list.end - list.begin + BLOCK - 1u) / BLOCK;
}

// PARTS work-groups share the blocks of a coarse cluster.
kernel void refine_lights_blocks(LIGHT_ARGS(const), COARSE_LIST_ARGS(const),
                                 // out [blocks][2]: the least and the greatest of the lights'
                                 // positions; w: the least and the greatest 1 / range^2
                                 global float4* restrict blocks) {
    local float4 lows[GROUP], highs[GROUP];
    uint item = get_local_id(0), lead = item / BLOCK_ITEMS * BLOCK_ITEMS;
    CoarseList list = coarse_list(coarse_offsets, coarse_capacity, get_group_id(0) / PARTS);
    uint count = blocks_of(list);
    uint step = GROUP / BLOCK_ITEMS;
    for (uint begin = get_group_id(0) % PARTS * step; begin < count; begin += PARTS * step) {
        uint b = begin + item / BLOCK_ITEMS;
        uint last = list.end - 1u;
        uint first = min(list.begin + b * BLOCK + (item - lead) * (BLOCK / BLOCK_ITEMS), last);
        float4 low = bounds[coarse_lists[first]], high = low;
#pragma unroll
        for (uint i = 1u; i < BLOCK / BLOCK_ITEMS; ++i) {
            float4 light = bounds[coarse_lists[min(first + i, last)]];
            low = min(low, light);
            high = max(high, light);
        }
        lows[item] = low;
        highs[item] = high;
#if GROUP % 4 == 0
        barrier(CLK_LOCAL_MEM_FENCE);  // all are there
#endif
        if (item == lead && b < count) {
            for (uint i = lead + 1u; i < lead + BLOCK_ITEMS; ++i) {
                low = min(low, lows[i]);
                high = max(high, highs[i]);
            }
            blocks[2u * (list.block + b)] = low;
            blocks[2u * (list.block + b) + 1u] = high;
        }
#if GROUP % 4 == 0
        barrier(CLK_LOCAL_MEM_FENCE);  // all are used up
#endif
    }
}

// 1 if a light of a block may reach the cluster. Rounding is monotone, so the block's box is never
// farther from the cluster, as sphere_reaches() computes it, than one of its lights.
static inline uint block_reaches(ActiveCluster c, float4 low, float4 high) {
    float dx = max(max(c.min_x - high.x, low.x - c.max_x), 0.0f);
    float dy = max(max(c.min_y - high.y, low.y - c.max_y), 0.0f);
    float dz = max(max(c.min_z - high.z, low.z - c.max_z), 0.0f);
    return select(0u, 1u, sphere_reaches(dx, dy, dz, low.w));
}

// Which of GROUP blocks from number `first` on may reach the cluster, ascending, in `found`:
// [GROUP]; returns how many. `turn`: of ballots.
static inline uint find_blocks(ActiveCluster c, global const float4* blocks, uint first, uint count,
                               uint turn, local uint* ballots, local uint* found) {
    uint b = first + (uint)get_local_id(0);
    uint flag = 0u;
    if (b < count) flag = block_reaches(c, blocks[2u * b], blocks[2u * b + 1u]);
#if GROUP == 1
    found[0] = b;
    return flag;
#else
    GroupBallot ballot = group_ballot(flag, GROUP, turn, ballots);
    if (ballot.flag != 0u) found[ballot.before] = b;
    barrier(CLK_LOCAL_MEM_FENCE);  // they are there
    return ballot.total;
#endif
}
#endif

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
    uint bit = item * VW;
    uint total = 0;
    uint before = popcount(ballots[bit / 32] & ((1u << (bit % 32)) - 1u));
    for (uint word = 0; word < (BATCH + 31) / 32; ++word) {
        uint count = popcount(ballots[word]);
        before += word < bit / 32 ? count : 0u;
        total += count;
    }
    for (uint i = 0; i < VW; ++i) {
        if (flag[i] && before < room) out[before] = (LIGHT_INDEX)batch->light[i];
        before += flag[i];
    }
    barrier(CLK_LOCAL_MEM_FENCE);  // ballots are counted before the next batch clears them
    return total;
#endif
}

// What a work-group refines from, and where to.
typedef struct Refining {
    global const ShadeLight* lights;
    global const float4* bounds;
    global const LIGHT_INDEX* coarse;
    global LIGHT_INDEX* lists;
    uint capacity;  // of lists
    local uint* ballots;
} Refining;

// Appends those of a batch's lights that reach the cluster, at `place` of the lists; returns how
// many. The work-item has those from `entry` of the coarse list on.
static inline uint refine_batch(Refining r, ActiveCluster c, uint entry, uint end, uint place) {
    Batch batch;
    load_batch(r.coarse, entry, end, &batch);
    UV flags = (UV)(0u);
    if (batch.count > 0u) flags = reaching_lanes(c, r.lights, r.bounds, &batch);
    uint room = place < r.capacity ? r.capacity - place : 0u;
    return append(flags, &batch, r.lists + place, room, r.ballots);
}

// blocks: null with BLOCK 0.
kernel void refine_lights(LIGHT_ARGS(const), View view, COARSE_LIST_ARGS(const),
                          CLUSTER_ARGS(),  // in/out: the clusters' lists set
                          global const uint* restrict list_offsets,  // [tiles + 1], reserves
                          global const float4* restrict blocks, LIST_ARGS()) {
    local uint ballots[(BATCH + 31) / 32];
#if BLOCK > 0
    local uint block_ballots[BALLOT_WORDS(GROUP)];
    local uint found[GROUP];
    uint turn = 0u;  // of block_ballots
    clear_ballots(GROUP, GROUP, block_ballots);
#if GROUP > 1
    barrier(CLK_LOCAL_MEM_FENCE);
#endif
#endif
    uint tile = get_group_id(0);
    uint place = list_offsets[tile];
    uint item = (uint)get_local_id(0) * VW;
    Clusters active = CLUSTERS_OF_ARGS;
    Refining refining = {lights, bounds, coarse_lists, lists, list_capacity, ballots};
    FOR_EACH_CLUSTER(i, active, tile) {
        ActiveCluster c = clusters[i];
        CoarseList from =
            coarse_list(coarse_offsets, coarse_capacity, coarse_cluster(view, grid, tile, c.slice));
        uint begin = place;
#if BLOCK > 0
        for (uint first = 0; first < blocks_of(from); first += GROUP) {
            uint entries = BLOCK * find_blocks(c, blocks + 2u * from.block, first, blocks_of(from),
                                               turn++, block_ballots, found);
            for (uint at = item; at - item < entries; at += BATCH) {
                uint entry =
                    at < entries ? from.begin + found[at / BLOCK] * BLOCK + at % BLOCK : from.end;
                place += refine_batch(refining, c, entry, from.end, place);
            }
        }
#else
        for (uint first = from.begin; first < from.end; first += BATCH) {
            place += refine_batch(refining, c, first + item, from.end, place);
        }
#endif
#if GROUP > 1
        barrier(CLK_GLOBAL_MEM_FENCE);  // all have read the cluster before its list is set
#endif
        if (item == 0u) {
            clusters[i].list_begin = min(begin, list_capacity);
            clusters[i].list_count = min(place, list_capacity) - min(begin, list_capacity);
        }
    }
}
