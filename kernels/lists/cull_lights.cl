// SPDX-License-Identifier: Apache-2.0
// Lists the lights of every coarse cluster: a stable counting sort of (light, cluster) pairs.
//
//   cull_lights_count   pairs by (chunk of lights, cluster)
//   cull_lights_offset  where each chunk's pairs begin within each cluster, and its total
//   (prefix_sum over clusters)
//   cull_lights_fill    writes the light indices
//
// A work-group walks one contiguous chunk of the lights in order and spreads one light's rows of
// clusters over its work-items, so no two of them ever meet in a cluster: lists ascend by light
// index without atomics, and are the same for every group size and number of chunks.
#include "kernels/device/arguments.h"
#include "kernels/device/chunk_starts.h"
#include "kernels/lists/light_reach.h"

typedef struct ClusterBoxes {
    global const float2* columns;  // [slices][tiles_x]
    global const float2* rows;     // [slices][tiles_y]
    global const float2* depths;   // [slices]
    // [cluster_count]: 0 for clusters that need no list; null: all do
    global const uchar* occupied;
} ClusterBoxes;

// The target of pairs: counted, or filled in.
typedef struct PairSink {
    global uint* cursors;        // [cursor_stride] of this chunk
    global const uint* offsets;  // [cluster_count + 1]; fill only
    global LIGHT_INDEX* lists;   // fill only
    uint capacity;               // of lists
} PairSink;

static inline void put_pair(PairSink sink, uint cluster, uint light, bool fill) {
    uint slot = sink.cursors[cluster]++;
    if (!fill) return;
    uint place = sink.offsets[cluster] + slot;
    if (place < sink.capacity) sink.lists[place] = (LIGHT_INDEX)light;
}

// A light and where its sphere can be in the grid.
typedef struct Candidate {
    uint light;
    float4 bound;  // x, y, depth, 1/range^2
    ShadeLight spot;
    LightExtent extent;
} Candidate;

// A row of clusters (one slice, one tile row), its columns first .. end - 1 that may need lists,
// and the light's distances to the row by axis.
typedef struct ClusterRow {
    uint slice, row;
    uint first, end;
    float dy, dz;
} ClusterRow;

static inline bool needs_list(ClusterBoxes boxes, uint cluster) {
    return !boxes.occupied || boxes.occupied[cluster] != 0;
}

static inline ClusterRow cluster_row(ClusterGrid grid, ClusterBoxes boxes, LightExtent extent,
                                     uint slice, uint row) {
    uint base = cluster_index(grid, 0u, row, slice);
    ClusterRow r;
    r.slice = slice;
    r.row = row;
    r.first = extent.columns & 0xffffu;
    r.end = (extent.columns >> 16) + 1u;
    while (r.first < r.end && !needs_list(boxes, base + r.first)) ++r.first;
    while (r.first < r.end && !needs_list(boxes, base + r.end - 1u)) --r.end;
    return r;
}

static inline bool reaches_column(Candidate c, ClusterGrid grid, ClusterBoxes boxes, ClusterRow r,
                                  uint column) {
    float2 x = boxes.columns[r.slice * grid.tiles_x + column];
    return sphere_reaches(interval_distance(c.bound.x, x.x, x.y), r.dy, r.dz, c.bound.w);
}

static inline bool cone_reaches_column(Candidate c, ClusterGrid grid, ClusterBoxes boxes,
                                       ClusterRow r, uint column) {
#if HAS_SPOT_LIGHTS
    float2 x = boxes.columns[r.slice * grid.tiles_x + column];
    float2 y = boxes.rows[r.slice * grid.tiles_y + r.row];
    float2 z = boxes.depths[r.slice];
    return cone_reaches(c.spot, (float3)(x.x, y.x, -z.y), (float3)(x.y, y.y, -z.x));
#else
    return true;
#endif
}

// The columns of a row that the sphere reaches are neighbours, since boxes are ordered along x:
// find both ends, and all between belong.
static inline void walk_row(Candidate c, ClusterGrid grid, ClusterBoxes boxes, ClusterRow r,
                            PairSink sink, bool fill) {
    uint first = r.first;
    uint end = r.end;
    while (first < end && !reaches_column(c, grid, boxes, r, first)) ++first;
    while (first < end && !reaches_column(c, grid, boxes, r, end - 1u)) --end;
    uint base = cluster_index(grid, 0u, r.row, r.slice);
    for (uint column = first; column < end; ++column) {
        if (needs_list(boxes, base + column) && cone_reaches_column(c, grid, boxes, r, column))
            put_pair(sink, base + column, c.light, fill);
    }
}

static inline void walk_light(Candidate c, ClusterGrid grid, ClusterBoxes boxes, PairSink sink,
                              bool fill) {
    uint first_slice = c.extent.slices & 0xffffu;
    uint first_row = c.extent.rows & 0xffffu;
    uint row_count = (c.extent.rows >> 16) + 1u - first_row;
    uint total = ((c.extent.slices >> 16) + 1u - first_slice) * row_count;
    for (uint i = get_local_id(0); i < total; i += get_local_size(0)) {
        ClusterRow r = cluster_row(grid, boxes, c.extent, first_slice + i / row_count,
                                   first_row + i % row_count);
        if (r.first >= r.end) continue;
        float2 y = boxes.rows[r.slice * grid.tiles_y + r.row];
        float2 z = boxes.depths[r.slice];
        r.dy = interval_distance(c.bound.y, y.x, y.y);
        r.dz = interval_distance(c.bound.z, z.x, z.y);
        if (sphere_reaches(0.0f, r.dy, r.dz, c.bound.w)) walk_row(c, grid, boxes, r, sink, fill);
    }
}

static inline bool is_empty_interval(uint packed) { return (packed & 0xffffu) > (packed >> 16); }

static inline bool touches_grid(LightExtent e) {
    return !is_empty_interval(e.slices) && !is_empty_interval(e.columns) &&
           !is_empty_interval(e.rows);
}

// This work-group's chunk. Neighbouring groups get chunks far apart, since threads of a CPU take
// neighbouring groups and neighbouring lights cost alike: lights near the camera are in many
// clusters. The factor is a prime above every number of chunks, so each chunk belongs to one group.
static inline size_t chunk_of_group(void) {
    return (ulong)get_group_id(0) * 2654435761ul % get_num_groups(0);
}

// The lights of a chunk: [first, end).
static inline uint2 lights_of_chunk(uint count, ulong chunk) {
    ulong chunks = get_num_groups(0);
    return (uint2)((uint)(count * chunk / chunks), (uint)(count * (chunk + 1u) / chunks));
}

static inline void walk_chunk(global const ShadeLight* lights, global const float4* bounds,
                              global const LightExtent* extents, uint count, ClusterGrid grid,
                              ClusterBoxes boxes, PairSink sink, bool fill) {
    uint2 chunk = lights_of_chunk(count, chunk_of_group());
    for (uint light = chunk.x; light < chunk.y; ++light) {
        Candidate c;
        c.extent = extents[light];
        if (!touches_grid(c.extent)) continue;
        c.light = light;
        c.bound = bounds[light];
        c.bound.z = -c.bound.z;
#if HAS_SPOT_LIGHTS
        c.spot = lights[light];
#endif
        walk_light(c, grid, boxes, sink, fill);
        // The next light's rows may fall to other work-items: they must see this one's cursors.
        barrier(CLK_GLOBAL_MEM_FENCE);
    }
}

kernel void cull_lights_count(
    LIGHT_ARGS(const), BOX_ARGS(const),
    global const uchar* restrict occupied,  // [cluster_count], or null
    global uint* restrict cursors) {        // out [chunks][cursor_stride]: pairs
    ClusterBoxes boxes = {columns, rows, depths, occupied};
    uint stride = cursor_stride(grid.cluster_count);
    PairSink sink = {cursors + chunk_of_group() * stride, 0, 0, 0u};
    for (uint i = get_local_id(0); i < stride; i += get_local_size(0)) sink.cursors[i] = 0u;
    // All work-items zero the cursors before any counts.
    barrier(CLK_GLOBAL_MEM_FENCE);
    walk_chunk(lights, bounds, extents, light_count, grid, boxes, sink, false);
}

// One work-item for VW clusters: chunk counts become chunk starts within the cluster.
kernel void cull_lights_offset(
    uint cluster_count, uint chunk_count,
    global uint* restrict cursors,   // in: pairs, out: starts [chunk_count][cursor_stride]
    global uint* restrict counts) {  // out [cursor_stride]: pairs of each cluster
    uint cluster = (uint)get_global_id(0) * VW;
    if (cluster < cluster_count) chunk_starts(cursors, cluster_count, chunk_count, cluster, counts);
}

kernel void cull_lights_fill(
    LIGHT_ARGS(const), BOX_ARGS(const), global const uchar* restrict occupied,
    global uint* restrict cursors,  // in: starts [chunks][cursor_stride]; used up
    COARSE_LIST_ARGS()) {           // out: lists
    ClusterBoxes boxes = {columns, rows, depths, occupied};
    PairSink sink = {cursors + chunk_of_group() * cursor_stride(grid.cluster_count), coarse_offsets,
                     coarse_lists, coarse_capacity};
    walk_chunk(lights, bounds, extents, light_count, grid, boxes, sink, true);
}

static inline bool holds(uint interval, uint i) {
    return (interval & 0xffffu) <= i && i <= (interval >> 16);
}

// The oracle: every light against every cluster. One work-item a cluster. With `lists` null it
// counts, else it fills at `offsets`. Tests use it, and benchmarks as a baseline.
kernel void cull_lights_brute_force(LIGHT_ARGS(const), BOX_ARGS(const), uint fill,
                                    global uint* restrict counts,  // out [cluster_count]
                                    COARSE_LIST_ARGS()) {          // out: lists, if fill
    uint cluster = get_global_id(0);
    if (cluster >= grid.cluster_count) return;
    uint column = cluster % grid.tiles_x;
    uint row = cluster / grid.tiles_x % grid.tiles_y;
    uint slice = cluster / grid.tiles_x / grid.tiles_y;
    float2 x = columns[slice * grid.tiles_x + column];
    float2 y = rows[slice * grid.tiles_y + row];
    float2 z = depths[slice];
    uint found = 0;
    for (uint light = 0; light < light_count; ++light) {
        float4 b = bounds[light];
        bool reaches =
            sphere_reaches(interval_distance(b.x, x.x, x.y), interval_distance(b.y, y.x, y.y),
                           interval_distance(-b.z, z.x, z.y), b.w);
#if HAS_SPOT_LIGHTS
        reaches = reaches &&
                  cone_reaches(lights[light], (float3)(x.x, y.x, -z.y), (float3)(x.y, y.y, -z.x));
#endif
        // A box reaches beyond its cluster's part of the view: there the light's extent decides.
        LightExtent e = extents[light];
        reaches =
            reaches && holds(e.columns, column) && holds(e.rows, row) && holds(e.slices, slice);
        if (!reaches) continue;
        if (fill) coarse_lists[coarse_offsets[cluster] + found] = (LIGHT_INDEX)light;
        ++found;
    }
    counts[cluster] = found;
}
