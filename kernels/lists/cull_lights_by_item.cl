// SPDX-License-Identifier: Apache-2.0
// cull_lights for devices whose work-items work alone: a stable counting sort of (light, cluster)
// pairs. A work-item walks one contiguous chunk of the lights in order, so lists ascend by light
// index without atomics.
//   cull_lights_count   pairs by (chunk of lights, cluster)
//   cull_lights_offset  where each chunk's pairs begin within each cluster, and its total
//   (prefix_sum over clusters)
//   cull_lights_fill    writes the light indices
#include "kernels/device/chunk_starts.h"
#include "kernels/lists/cull_lights.h"

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
    for (uint i = 0; i < total; ++i) {
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

// This work-item's chunk. Neighbouring work-groups get chunks far apart, since threads of a CPU
// take neighbouring groups and neighbouring lights cost alike: lights near the camera are in many
// clusters. The factor is a prime above every number of chunks, so each chunk belongs to one item.
static inline size_t chunk_of_item(void) {
    return (ulong)get_group_id(0) * 2654435761ul % get_num_groups(0);
}

static inline void walk_chunk(global const ShadeLight* lights, global const float4* bounds,
                              global const LightExtent* extents, uint count, ClusterGrid grid,
                              ClusterBoxes boxes, PairSink sink, bool fill) {
    uint2 chunk = part_of_chunk(count, chunk_of_item(), get_num_groups(0));
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
    }
}

kernel void cull_lights_count(
    LIGHT_ARGS(const), BOX_ARGS(const),
    global const uchar* restrict occupied,  // [cluster_count], or null
    global uint* restrict cursors) {        // out [chunks][cursor_stride]: pairs
    ClusterBoxes boxes = {columns, rows, depths, occupied};
    uint stride = cursor_stride(grid.cluster_count);
    PairSink sink = {cursors + chunk_of_item() * stride, 0, 0, 0u};
    for (uint i = 0; i < stride; ++i) sink.cursors[i] = 0u;
    walk_chunk(lights, bounds, extents, light_count, grid, boxes, sink, false);
}

kernel void cull_lights_fill(
    LIGHT_ARGS(const), BOX_ARGS(const), global const uchar* restrict occupied,
    global uint* restrict cursors,  // in: starts [chunks][cursor_stride]; used up
    COARSE_LIST_ARGS()) {           // out: lists
    ClusterBoxes boxes = {columns, rows, depths, occupied};
    PairSink sink = {cursors + chunk_of_item() * cursor_stride(grid.cluster_count), coarse_offsets,
                     coarse_lists, coarse_capacity};
    walk_chunk(lights, bounds, extents, light_count, grid, boxes, sink, true);
}

// One work-item for VW clusters: chunk counts become chunk starts within the cluster.
kernel void cull_lights_offset(
    uint cluster_count, uint chunk_count,
    global uint* restrict cursors,   // in: pairs, out: starts [chunk_count][cursor_stride]
    global uint* restrict counts) {  // out [cursor_stride]: pairs of each cluster
    uint cluster = (uint)get_global_id(0) * VW;
    if (cluster < cluster_count) chunk_starts(cursors, cluster_count, chunk_count, cluster, counts);
}
