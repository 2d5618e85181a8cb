// SPDX-License-Identifier: Apache-2.0
// cull_lights for devices that run many work-groups at once: each cluster gathers its lights. What
// cannot reach a cluster is skipped: segments, spans, blocks, lights. Neighbours among the lights
// are neighbours in space (light_order.h), so that most are skipped; where they are not, lists are
// the same.
//   cull_lights_blocks  the extents of blocks and spans
//   cull_lights_tasks   each cluster's tasks: the segments of lights that can reach it
//   cull_lights_count   the lights of each task
//   cull_lights_starts  where each task's lights begin within its cluster's, and their total
//   (prefix_sum over clusters)
//   cull_lights_fill    writes the light indices
#include "kernels/device/group_ballot.h"
#include "kernels/lists/cull_lights.h"

// The host defines BLOCK, the lights of a block, SPAN, the blocks of a span, BLOCK_GROUP, the
// work-items that join a span's extents, and SEGMENTS, the largest number of segments, a multiple
// of 32. Segments have equally many spans, or one more.
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
                               global uint* restrict task_count) {   // out [1]: 0
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
    if (span == 0u) task_count[0] = 0u;
}

// ByGroup of host/stages/lists/cull_lights.h. A task: cluster * segment_count + segment; there are
// at most cluster_count * segment_count.
#define TASK_ARGS(access)                                                                  \
    uint segment_count, global const LightExtent *restrict blocks,                         \
        global const LightExtent *restrict spans, global access uint *restrict task_count, \
        global access uint *restrict tasks

// The spans of a segment: [first, end).
static inline uint2 spans_of_segment(uint light_count, uint segment, uint segment_count) {
    return part_of_chunk(span_count(light_count), segment, segment_count);
}

// One work-group a cluster. Tasks of a cluster lie beside each other, ascending by segment. The
// order of clusters may vary.
kernel void cull_lights_tasks(
    uint light_count, BOX_ARGS(const),
    global const uchar* restrict occupied,  // [cluster_count], or null
    TASK_ARGS(),                            // in, out: task_count; out: tasks
    global uint* restrict cluster_tasks) {  // out [cluster_count][2]: first, number
    local uint reaching[SEGMENTS / 32];     // a bit for each segment
    local uint begin;
    uint item = get_local_id(0), cluster = get_group_id(0);
    ClusterBoxes boxes = {columns, rows, depths, occupied};
    BoxedCluster c = boxed_cluster(grid, boxes, cluster);
    uint end = needs_list(boxes, cluster) ? segment_count : 0u, words = (end + 31u) / 32u;
    for (uint word = item; word < words; word += GROUP) reaching[word] = 0u;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint segment = item; segment < end; segment += GROUP) {
        uint2 from = spans_of_segment(light_count, segment, segment_count);
        uint reaches = 0u;
        for (uint span = from.x; span < from.y; ++span) reaches |= extent_holds(spans[span], c);
        if (reaches != 0u) atomic_or(reaching + segment / 32u, 1u << (segment % 32u));
    }
    barrier(CLK_LOCAL_MEM_FENCE);  // the bits are there
    if (item == 0u) {
        uint total = 0u;
        for (uint word = 0; word < words; ++word) total += popcount(reaching[word]);
        begin = total > 0u ? atomic_add(task_count, total) : 0u;
        cluster_tasks[2u * cluster] = begin;
        cluster_tasks[2u * cluster + 1u] = total;
    }
    barrier(CLK_LOCAL_MEM_FENCE);  // the first place is there
    for (uint segment = item; segment < end; segment += GROUP) {
        uint bits = reaching[segment / 32u], bit = 1u << (segment % 32u);
        if ((bits & bit) == 0u) continue;
        uint place = begin + popcount(bits & (bit - 1u));
        for (uint word = 0; word < segment / 32u; ++word) place += popcount(reaching[word]);
        tasks[place] = cluster * segment_count + segment;
    }
}

// One work-item a cluster.
kernel void cull_lights_starts(uint cluster_count,
                               global const uint* restrict cluster_tasks,  // [cluster_count][2]
                               global const uint* restrict task_lights,    // [tasks]
                               global uint* restrict task_starts,          // out [tasks]
                               global uint* restrict counts) {             // out [cluster_count]
    uint cluster = get_global_id(0);
    if (cluster >= cluster_count) return;
    uint first = cluster_tasks[2u * cluster], end = first + cluster_tasks[2u * cluster + 1u];
    uint sum = 0u;
    for (uint task = first; task < end; ++task) {
        task_starts[task] = sum;
        sum += task_lights[task];
    }
    counts[cluster] = sum;
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
    uchar blocks[SPAN];  // of a span, that can reach the cluster
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

static inline void gather_task(LightBlocks from, BoxedCluster c, uint segment, uint segment_count,
                               GroupSink* sink, local GroupMemory* memory) {
    uint2 spans = spans_of_segment(from.count, segment, segment_count);
    for (uint span = spans.x; span < spans.y; ++span) {
        if (extent_holds(from.spans[span], c) != 0u) gather_span(from, c, span, sink, memory);
    }
}

#define BLOCKS_OF_ARGS ((LightBlocks){lights, bounds, extents, blocks, spans, light_count})

// Work-groups take equally many tasks.
kernel void cull_lights_count(LIGHT_ARGS(const), BOX_ARGS(const), TASK_ARGS(const),
                              global uint* restrict task_lights) {  // out [tasks]
    local GroupMemory memory;
    clear_ballots(GROUP, GROUP, memory.ballots);
    barrier(CLK_LOCAL_MEM_FENCE);
    ClusterBoxes boxes = {columns, rows, depths, 0};
    GroupSink sink = {0, 0u, 0u, 0u};
    uint end = task_count[0];
    for (uint i = get_group_id(0); i < end; i += get_num_groups(0)) {
        uint cluster = tasks[i] / segment_count, segment = tasks[i] % segment_count;
        sink.place = 0u;
        gather_task(BLOCKS_OF_ARGS, boxed_cluster(grid, boxes, cluster), segment, segment_count,
                    &sink, &memory);
        if (get_local_id(0) == 0) task_lights[i] = sink.place;
    }
}

kernel void cull_lights_fill(LIGHT_ARGS(const), BOX_ARGS(const), TASK_ARGS(const),
                             global const uint* restrict task_starts,  // [tasks]
                             COARSE_LIST_ARGS()) {                     // out: lists
    local GroupMemory memory;
    clear_ballots(GROUP, GROUP, memory.ballots);
    barrier(CLK_LOCAL_MEM_FENCE);
    ClusterBoxes boxes = {columns, rows, depths, 0};
    GroupSink sink = {coarse_lists, 0u, coarse_capacity, 0u};
    uint end = task_count[0];
    for (uint i = get_group_id(0); i < end; i += get_num_groups(0)) {
        uint cluster = tasks[i] / segment_count, segment = tasks[i] % segment_count;
        sink.place = coarse_offsets[cluster] + task_starts[i];
        gather_task(BLOCKS_OF_ARGS, boxed_cluster(grid, boxes, cluster), segment, segment_count,
                    &sink, &memory);
    }
}
