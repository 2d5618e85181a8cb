// SPDX-License-Identifier: Apache-2.0
// cull_lights for devices that run many work-groups at once: each cluster gathers its lights. A
// work-group takes a cluster and a chunk of the lights at a time and skips what cannot reach the
// cluster: spans, blocks, lights. Neighbours among the lights are neighbours in space
// (light_order.h), so that most are skipped; where they are not, lists are the same.
//   cull_lights_blocks    the extents of blocks and spans
//   cull_lights_clusters  which clusters need a list
#include "kernels/device/group_ballot.h"
#include "kernels/lists/cull_lights.h"

// The host defines BLOCK, the lights of a block, SPAN, the blocks of a span, and BLOCK_GROUP, the
// work-items that find the blocks of a span.
#define SPAN_LIGHTS (BLOCK * SPAN)

// The extent of no light: joined with another one, it is the other one.
static inline LightExtent empty_extent(void) {
    LightExtent e = {0xffffu, 0xffffu, 0xffffu, 0u};  // from 65535 to 0
    return e;
}

static inline uint joined_interval(uint a, uint b) {
    return min(a & 0xffffu, b & 0xffffu) | (max(a >> 16, b >> 16) << 16);
}

// What both hold, and what lies between them.
static inline LightExtent joined_extent(LightExtent a, LightExtent b) {
    a.columns = joined_interval(a.columns, b.columns);
    a.rows = joined_interval(a.rows, b.rows);
    a.slices = joined_interval(a.slices, b.slices);
    return a;
}

// Work-items that share a block.
#define BLOCK_ITEMS 4u
#define ITEM_LIGHTS (BLOCK / BLOCK_ITEMS)

// What a work-item's lights of a block reach.
static inline LightExtent extent_of_lights(global const LightExtent* extents, uint first,
                                           uint end) {
    LightExtent joined = empty_extent();
    if (first >= end) return joined;
#pragma unroll
    for (uint i = 0; i < ITEM_LIGHTS; ++i) {
        LightExtent e = extents[min(first + i, end - 1u)];
        joined = joined_extent(joined, touches_grid(e) ? e : empty_extent());
    }
    return joined;
}

static inline uint span_count(uint light_count) {
    return (light_count + SPAN_LIGHTS - 1u) / SPAN_LIGHTS;
}

// One work-group of BLOCK_GROUP items takes one span.
kernel void cull_lights_blocks(LIGHT_ARGS(const),
                               global LightExtent* restrict blocks,  // out [spans][SPAN]
                               global LightExtent* restrict spans,   // out [spans]
                               global uint* restrict work_count) {   // out [1]: 0
    local LightExtent parts[BLOCK_GROUP];
    uint span = get_group_id(0);
    uint item = get_local_id(0), lead = item / BLOCK_ITEMS * BLOCK_ITEMS;
    LightExtent whole = empty_extent();
    for (uint b = item / BLOCK_ITEMS; b < SPAN; b += BLOCK_GROUP / BLOCK_ITEMS) {
        uint block = span * SPAN + b;
        uint first = block * BLOCK + (item - lead) * ITEM_LIGHTS;
        parts[item] = extent_of_lights(extents, first, light_count);
        barrier(CLK_LOCAL_MEM_FENCE);  // the parts are there
        if (item == lead) {
            LightExtent joined = parts[item];
            for (uint i = 1; i < BLOCK_ITEMS; ++i) joined = joined_extent(joined, parts[item + i]);
            blocks[block] = joined;
            whole = joined_extent(whole, joined);
        }
        barrier(CLK_LOCAL_MEM_FENCE);  // the parts are used up
    }
    parts[item] = whole;
    for (uint step = BLOCK_GROUP / 2u; step >= BLOCK_ITEMS; step /= 2u) {
        barrier(CLK_LOCAL_MEM_FENCE);
        if (item < step) parts[item] = joined_extent(parts[item], parts[item + step]);
    }
    if (item != 0u) return;
    spans[span] = parts[0];
    if (span == 0u) work_count[0] = 0u;
}

// One work-item a cluster. Counts of clusters without a list become 0.
kernel void cull_lights_clusters(uint cluster_count, uint chunk_count,
                                 global const uchar* restrict occupied,  // [cluster_count], or null
                                 global uint* restrict cursors,  // out [chunk_count][cursor_stride]
                                 global uint* restrict work_count,  // in/out [1]
                                 global uint* restrict work) {      // out: clusters, in any order
    uint cluster = get_global_id(0);
    if (cluster >= cluster_count) return;
    ClusterBoxes boxes = {0, 0, 0, occupied};
    if (needs_list(boxes, cluster)) {
        work[atomic_inc(work_count)] = cluster;
        return;
    }
    uint stride = cursor_stride(cluster_count);
    for (uint chunk = 0; chunk < chunk_count; ++chunk) cursors[chunk * stride + cluster] = 0u;
}

typedef struct LightBlocks {
    global const ShadeLight* lights;
    global const float4* bounds;
    global const LightExtent* extents;
    global const LightExtent* blocks;
    global const LightExtent* spans;
    uint count;  // of lights
} LightBlocks;

typedef struct GroupMemory {
    uint ballots[BALLOT_WORDS(GROUP)];
    uint spans[GROUP];   // that can reach the cluster
    uchar blocks[SPAN];  // of a span, that can reach it
} GroupMemory;

// The target of a work-group's pairs: counted, or filled in.
typedef struct GroupSink {
    global LIGHT_INDEX* lists;
    uint place;     // of the next one
    uint capacity;  // of lists; 0: pairs are counted
    uint turn;      // of ballots
} GroupSink;

// Which blocks of the span can reach the cluster, ascending, in local memory; returns their number.
static inline uint find_blocks(LightBlocks from, BoxedCluster c, uint span, GroupSink* sink,
                               local GroupMemory* memory) {
    uint found = 0u;
    for (uint first = 0; first < SPAN; first += GROUP) {
        uint b = first + (uint)get_local_id(0);
        uint flag = extent_holds(from.blocks[span * SPAN + min(b, SPAN - 1u)], c);
        flag &= select(0u, 1u, b < SPAN);
        GroupBallot ballot = group_ballot(flag, GROUP, sink->turn++, memory->ballots);
        if (ballot.flag != 0u) memory->blocks[found + ballot.before] = (uchar)b;
        found += ballot.total;
    }
    barrier(CLK_LOCAL_MEM_FENCE);  // the blocks are there
    return found;
}

static inline void gather_span(LightBlocks from, BoxedCluster c, uint span, GroupSink* sink,
                               local GroupMemory* memory) {
    uint found = find_blocks(from, c, span, sink, memory);
    for (uint first = 0; first < found * BLOCK; first += GROUP) {
        uint i = first + (uint)get_local_id(0);
        uint block = memory->blocks[min(i / BLOCK, found - 1u)];
        uint light = (span * SPAN + block) * BLOCK + i % BLOCK;
        uint flag = i < found * BLOCK && light < from.count &&
                    is_listed(c, from.lights, from.bounds, from.extents, light);
        GroupBallot ballot = group_ballot(flag, GROUP, sink->turn++, memory->ballots);
        uint place = sink->place + ballot.before;
        if (ballot.flag != 0u && place < sink->capacity) sink->lists[place] = (LIGHT_INDEX)light;
        sink->place += ballot.total;
    }
}

// Of at most GROUP spans from `first` on, those that can reach the cluster, ascending, in local
// memory; returns their number.
static inline uint find_spans(LightBlocks from, BoxedCluster c, uint first, uint end,
                              GroupSink* sink, local GroupMemory* memory) {
    uint span = first + (uint)get_local_id(0);
    uint flag = extent_holds(from.spans[min(span, end - 1u)], c) & select(0u, 1u, span < end);
    GroupBallot ballot = group_ballot(flag, GROUP, sink->turn++, memory->ballots);
    if (ballot.flag != 0u) memory->spans[ballot.before] = span;
    barrier(CLK_LOCAL_MEM_FENCE);  // the spans are there
    return ballot.total;
}

static inline void gather_chunk(LightBlocks from, BoxedCluster c, uint chunk, uint chunk_count,
                                GroupSink* sink, local GroupMemory* memory) {
    uint2 spans = part_of_chunk(span_count(from.count), chunk, chunk_count);
    for (uint first = spans.x; first < spans.y; first += GROUP) {
        uint found = find_spans(from, c, first, spans.y, sink, memory);
        for (uint i = 0; i < found; ++i) gather_span(from, c, memory->spans[i], sink, memory);
    }
}

#define BLOCK_ARGS                                                                       \
    global const LightExtent *restrict blocks, global const LightExtent *restrict spans, \
        global const uint *restrict work_count, global const uint *restrict work
#define BLOCKS_OF_ARGS ((LightBlocks){lights, bounds, extents, blocks, spans, light_count})

// Work-groups share clusters and chunks evenly.
kernel void cull_lights_count(LIGHT_ARGS(const), BOX_ARGS(const), BLOCK_ARGS, uint chunk_count,
                              global uint* restrict cursors) {  // out [chunk_count][cursor_stride]
    local GroupMemory memory;
    clear_ballots(GROUP, GROUP, memory.ballots);
    barrier(CLK_LOCAL_MEM_FENCE);
    ClusterBoxes boxes = {columns, rows, depths, 0};
    GroupSink sink = {0, 0u, 0u, 0u};
    uint items = work_count[0] * chunk_count;
    for (uint i = get_group_id(0); i < items; i += get_num_groups(0)) {
        uint cluster = work[i / chunk_count], chunk = i % chunk_count;
        sink.place = 0u;
        gather_chunk(BLOCKS_OF_ARGS, boxed_cluster(grid, boxes, cluster), chunk, chunk_count, &sink,
                     &memory);
        if (get_local_id(0) == 0) {
            cursors[chunk * cursor_stride(grid.cluster_count) + cluster] = sink.place;
        }
    }
}

kernel void cull_lights_fill(LIGHT_ARGS(const), BOX_ARGS(const), BLOCK_ARGS, uint chunk_count,
                             global const uint* restrict cursors,  // starts
                             COARSE_LIST_ARGS()) {                 // out: lists
    local GroupMemory memory;
    clear_ballots(GROUP, GROUP, memory.ballots);
    barrier(CLK_LOCAL_MEM_FENCE);
    ClusterBoxes boxes = {columns, rows, depths, 0};
    GroupSink sink = {coarse_lists, 0u, coarse_capacity, 0u};
    uint items = work_count[0] * chunk_count;
    for (uint i = get_group_id(0); i < items; i += get_num_groups(0)) {
        uint cluster = work[i / chunk_count], chunk = i % chunk_count;
        uint start = cursors[chunk * cursor_stride(grid.cluster_count) + cluster];
        sink.place = coarse_offsets[cluster] + start;
        gather_chunk(BLOCKS_OF_ARGS, boxed_cluster(grid, boxes, cluster), chunk, chunk_count, &sink,
                     &memory);
    }
}
