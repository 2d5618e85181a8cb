// SPDX-License-Identifier: Apache-2.0
// The common part of both forms of cull_lights, which list the lights of every coarse cluster: they
// count pairs of a light and a cluster, sum up the counts over clusters, and fill in the lights.
// Lists ascend by light index, and are the same for every form, group size and number of chunks or
// segments.
#ifndef KILOLUX_DEVICE_CULL_LIGHTS_H
#define KILOLUX_DEVICE_CULL_LIGHTS_H
#include "kernels/device/arguments.h"
#include "kernels/lists/light_reach.h"

typedef struct ClusterBoxes {
    global const float2* columns;  // [slices][tiles_x]
    global const float2* rows;     // [slices][tiles_y]
    global const float2* depths;   // [slices]
    // [cluster_count]: 0 for clusters that need no list; null: all do
    global const uchar* occupied;
} ClusterBoxes;

static inline bool needs_list(ClusterBoxes boxes, uint cluster) {
    return !boxes.occupied || boxes.occupied[cluster] != 0;
}

// 1 where an interval of tiles or slices of a LightExtent holds one, else 0. Selections, not
// branches: PoCL 3.1 loses values that branches made before barriers.
static inline uint holds(uint interval, uint i) {
    return select(0u, 1u, (interval & 0xffffu) <= i) & select(0u, 1u, i <= (interval >> 16));
}

static inline bool is_empty_interval(uint packed) { return (packed & 0xffffu) > (packed >> 16); }

static inline bool touches_grid(LightExtent e) {
    return !is_empty_interval(e.slices) && !is_empty_interval(e.columns) &&
           !is_empty_interval(e.rows);
}

// Chunk `chunk` of `count` things: [first, end).
static inline uint2 part_of_chunk(uint count, ulong chunk, ulong chunks) {
    return (uint2)((uint)(count * chunk / chunks), (uint)(count * (chunk + 1u) / chunks));
}

// A cluster with its box.
typedef struct BoxedCluster {
    uint column, row, slice;
    float2 x, y, z;  // view space, z: depths
} BoxedCluster;

static inline BoxedCluster boxed_cluster(ClusterGrid grid, ClusterBoxes boxes, uint cluster) {
    BoxedCluster c;
    c.column = cluster % grid.tiles_x;
    c.row = cluster / grid.tiles_x % grid.tiles_y;
    c.slice = cluster / grid.tiles_x / grid.tiles_y;
    c.x = boxes.columns[c.slice * grid.tiles_x + c.column];
    c.y = boxes.rows[c.slice * grid.tiles_y + c.row];
    c.z = boxes.depths[c.slice];
    return c;
}

static inline uint extent_holds(LightExtent e, BoxedCluster c) {
    return holds(e.columns, c.column) & holds(e.rows, c.row) & holds(e.slices, c.slice);
}

static inline bool is_listed(BoxedCluster c, global const ShadeLight* lights,
                             global const float4* bounds, global const LightExtent* extents,
                             uint light) {
    // A box reaches beyond its cluster's part of the view: there the light's extent decides.
    if (extent_holds(extents[light], c) == 0u) return false;
    float4 b = bounds[light];
    bool reaches =
        sphere_reaches(interval_distance(b.x, c.x.x, c.x.y), interval_distance(b.y, c.y.x, c.y.y),
                       interval_distance(-b.z, c.z.x, c.z.y), b.w);
#if HAS_SPOT_LIGHTS
    reaches = reaches && cone_reaches(lights[light], (float3)(c.x.x, c.y.x, -c.z.y),
                                      (float3)(c.x.y, c.y.y, -c.z.x));
#endif
    return reaches;
}

// The oracle: every light against every cluster. One work-item a cluster. With `fill` 0 it counts,
// else it fills at the offsets. Tests use it, and benchmarks as a baseline.
kernel void cull_lights_brute_force(LIGHT_ARGS(const), BOX_ARGS(const), uint fill,
                                    global uint* restrict counts,  // out [cluster_count]
                                    COARSE_LIST_ARGS()) {          // out: lists, if fill
    uint cluster = get_global_id(0);
    if (cluster >= grid.cluster_count) return;
    ClusterBoxes boxes = {columns, rows, depths, 0};
    BoxedCluster c = boxed_cluster(grid, boxes, cluster);
    uint found = 0;
    for (uint light = 0; light < light_count; ++light) {
        if (!is_listed(c, lights, bounds, extents, light)) continue;
        if (fill) coarse_lists[coarse_offsets[cluster] + found] = (LIGHT_INDEX)light;
        ++found;
    }
    counts[cluster] = found;
}
#endif
