// SPDX-License-Identifier: Apache-2.0
// Lists the triangles of every tile of the picture: a counting sort of (triangle, tile) pairs.
//
//   bin_triangles_bounds  the tiles that a triangle's box of pixels touches; none where no pixel
//                         can show it: turned away, outside, between pixels' centres
//   bin_triangles_clear   (groups only) cursors to 0
//   bin_triangles_count   pairs by (chunk of triangles, tile)
//   bin_triangles_offset  where each chunk's pairs begin within each tile, and its total
//   (prefix_sum over tiles)
//   bin_triangles_fill    writes the triangles' numbers
//
// GROUP == 1: a work-item walks a chunk, lists ascend. Else a work-group takes GROUP triangles, all
// cursors are one chunk's and are moved by atomics: lists have any order, which the raster does not
// see, since of equally near triangles the first by number shows.
#ifndef GROUP
#define GROUP 1
#endif
#include "kernels/device/chunk_starts.h"
#include "kernels/device/raster_tile.h"
#include "kernels/device/raster_triangle.h"

// Tiles of a box from which on each is tested against the triangle's edges, and from which on all
// items of a work-group share the tests.
#define FEW_TILES 4u
#define MANY_TILES 32u

kernel void bin_triangles_bounds(
    View view,
    global const InstanceRow* restrict instances,  // ascending first_triangle, and an end
    global const uint* restrict instance_blocks,   // by INSTANCE_BLOCK triangles
    global const MeshRow* restrict meshes, global const float* restrict vertices,
    global const uint* restrict indices, global const SurfaceMaterial* restrict materials,
    uint triangle_count,
    global uint* restrict columns,  // out [triangle_count, whole vectors]: intervals of tiles
    global uint* restrict rows) {   // out, likewise
    uint first = (uint)get_global_id(0) * VW;
    if (first >= triangle_count) return;
    SurfaceScene scene = {instances, instance_blocks, meshes, vertices, indices, materials, 0, 0};
    UV numbers = lane_numbers + first;
    ViewTriangles t = view_triangles(scene, numbers, lane_mask(numbers < (UV)(triangle_count)));
    PixelBounds b = pixel_bounds(view, t.v);
    MASK outside = is_empty_bounds(b);
    UV column_interval = (UV)(EMPTY_INTERVAL);
    UV row_interval = (UV)(EMPTY_INTERVAL);
    if (lane_any(~outside)) {
        FV3 seen[3];
        turn_from_longest(t.v);
        for (uint i = 0; i < 3; ++i) seen[i] = seen_vertex(view, t.v[i]);
        MASK kept =
            ~outside & ~outside_view(view, seen) & shows_side(facing_of(seen).sign, t.winding);
        UV x0 = KX_CONCAT(as_, UV)(b.x0) / TILE_WIDTH;
        UV x1 = KX_CONCAT(as_, UV)(b.x1) / TILE_WIDTH;
        UV y0 = KX_CONCAT(as_, UV)(b.y0) / TILE_HEIGHT;
        UV y1 = KX_CONCAT(as_, UV)(b.y1) / TILE_HEIGHT;
        column_interval = select(column_interval, x0 | x1 << 16, kept);
        row_interval = select(row_interval, y0 | y1 << 16, kept);
    }
    lane_store(column_interval, columns + first);
    lane_store(row_interval, rows + first);
}

// What finds a triangle's tiles, and where pairs go: counted, or filled in.
typedef struct TileWalk {
    SurfaceScene scene;
    View view;
    global uint* cursors;        // of this chunk, or of all
    global const uint* offsets;  // [tiles + 1]; fill only
    global uint* lists;          // fill only
    uint capacity;               // of lists
    bool fill;
    global const uchar* closed;  // [tiles]: 1 where no triangle is needed
    bool some_closed;            // else nothing is read of `closed`
} TileWalk;

static inline void put_triangle(TileWalk walk, uint tile, uint triangle) {
    if (walk.some_closed && walk.closed[tile] != 0) return;
#if GROUP == 1
    uint slot = walk.cursors[tile]++;
#else
    uint slot = atomic_inc(walk.cursors + tile);
#endif
    if (!walk.fill) return;
    uint place = walk.offsets[tile] + slot;
    if (place < walk.capacity) walk.lists[place] = triangle;
}

// One triangle's scaled edges.
typedef struct Edges {
    float3 e[3];
} Edges;

static inline float first_lane(FV v) {
#if VW == 1
    return v;
#else
    return v.s0;
#endif
}

static inline Edges edges_of(TileWalk walk, uint triangle) {
    UV number = (UV)(triangle);
    ViewTriangles t = view_triangles(walk.scene, number, (MASK)(-1));
    RasterTriangles r = set_up_triangles(walk.view, ray_span(walk.view), t);
    Edges out;
    for (uint i = 0; i < 3; ++i) {
        out.e[i] =
            (float3)(first_lane(r.edge[i].x), first_lane(r.edge[i].y), first_lane(r.edge[i].z));
    }
    return out;
}

// False only where the triangle surely covers none of the tile's pixels.
static inline bool touches_tile(View view, Edges edges, uint column, uint row) {
    float x0 = fma((float)(column * TILE_WIDTH) + 0.5f, view.ray.x, view.ray.y);
    float x1 = fma((float)(column * TILE_WIDTH + TILE_WIDTH) - 0.5f, view.ray.x, view.ray.y);
    float y0 = ray_y(view, row * TILE_HEIGHT);
    float y1 = ray_y(view, row * TILE_HEIGHT + TILE_HEIGHT - 1u);
    for (uint i = 0; i < 3; ++i) {
        float3 e = edges.e[i];
        float most = fmax(e.x * x0, e.x * x1) + fmax(e.y * y0, e.y * y1) - e.z;
        if (most < -1.0f) return false;
    }
    return true;
}

static inline void walk_few(TileWalk walk, uint triangle, uint columns, uint rows) {
    uint tiles_x = raster_tiles_x(walk.view);
    for (uint row = interval_first(rows); row <= rows >> 16; ++row) {
        for (uint column = interval_first(columns); column <= columns >> 16; ++column) {
            put_triangle(walk, row * tiles_x + column, triangle);
        }
    }
}

// Every `step`-th tile from number `first` on.
static inline void walk_many(TileWalk walk, uint triangle, uint columns, uint rows, uint first,
                             uint step) {
    uint tiles_x = raster_tiles_x(walk.view);
    uint across = interval_count(columns);
    uint total = across * interval_count(rows);
    Edges edges = edges_of(walk, triangle);
    for (uint i = first; i < total; i += step) {
        uint column = interval_first(columns) + i % across;
        uint row = interval_first(rows) + i / across;
        if (touches_tile(walk.view, edges, column, row)) {
            put_triangle(walk, row * tiles_x + column, triangle);
        }
    }
}

static inline uint tiles_of(uint columns, uint rows) {
    if (columns == EMPTY_INTERVAL) return 0u;
    return interval_count(columns) * interval_count(rows);
}

#if GROUP == 1
// This work-item's chunk of the triangles.
static inline void walk_chunk(TileWalk walk, global const uint* columns, global const uint* rows,
                              uint triangle_count) {
    ulong chunk = get_group_id(0);
    ulong chunks = get_num_groups(0);
    uint end = (uint)(triangle_count * (chunk + 1u) / chunks);
    for (uint i = (uint)(triangle_count * chunk / chunks); i < end; ++i) {
        uint tiles = tiles_of(columns[i], rows[i]);
        if (tiles == 0u) continue;
        if (tiles < FEW_TILES) {
            walk_few(walk, i, columns[i], rows[i]);
        } else {
            walk_many(walk, i, columns[i], rows[i], 0u, 1u);
        }
    }
}
#else
// This work-group's triangles: each item its own, and those of many tiles all items together.
static inline void walk_chunk(TileWalk walk, global const uint* columns, global const uint* rows,
                              uint triangle_count, local uint* many, local uint* many_count) {
    uint i = get_global_id(0);
    if (get_local_id(0) == 0) *many_count = 0u;
    barrier(CLK_LOCAL_MEM_FENCE);  // 0 before any item adds to it
    if (i < triangle_count) {
        uint tiles = tiles_of(columns[i], rows[i]);
        if (tiles >= MANY_TILES) {
            many[atomic_inc(many_count)] = i;
        } else if (tiles >= FEW_TILES) {
            walk_many(walk, i, columns[i], rows[i], 0u, 1u);
        } else if (tiles > 0u) {
            walk_few(walk, i, columns[i], rows[i]);
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);  // all are there
    for (uint j = 0; j < *many_count; ++j) {
        walk_many(walk, many[j], columns[many[j]], rows[many[j]], get_local_id(0), GROUP);
    }
}
#endif

kernel void bin_triangles_clear(uint count, global uint* restrict cursors) {
    uint i = get_global_id(0);
    if (i < count) cursors[i] = 0u;
}

#if GROUP == 1
#define WALK_CHUNK(walk) walk_chunk(walk, columns, rows, triangle_count)
#define CHUNK_CURSORS(view) \
    (cursors + get_group_id(0) * cursor_stride(raster_tiles_x(view) * raster_tiles_y(view)))
#else
#define WALK_CHUNK(walk)    \
    local uint many[GROUP]; \
    local uint many_count;  \
    walk_chunk(walk, columns, rows, triangle_count, many, &many_count)
#define CHUNK_CURSORS(view) cursors
#endif

kernel void bin_triangles_count(
    View view, global const InstanceRow* restrict instances,
    global const uint* restrict instance_blocks, global const MeshRow* restrict meshes,
    global const float* restrict vertices, global const uint* restrict indices,
    global const SurfaceMaterial* restrict materials, uint triangle_count,
    global const uint* restrict columns,  // [triangle_count]
    global const uint* restrict rows,     // [triangle_count]
    uint some_closed,                     // 0: `closed` is not read
    global const uchar* restrict closed,  // [tiles]: 1 where no triangle is needed
    global uint* restrict cursors) {      // out [chunks][cursor_stride]: pairs
    SurfaceScene scene = {instances, instance_blocks, meshes, vertices, indices, materials, 0, 0};
    TileWalk walk = {scene, view, CHUNK_CURSORS(view), 0, 0, 0u, false, closed, some_closed != 0};
#if GROUP == 1
    uint stride = cursor_stride(raster_tiles_x(view) * raster_tiles_y(view));
    for (uint i = 0; i < stride; ++i) walk.cursors[i] = 0u;
#endif
    WALK_CHUNK(walk);
}

// One work-item for VW tiles.
kernel void bin_triangles_offset(
    uint tile_count, uint chunk_count,
    global uint* restrict cursors,   // in: pairs, out: starts [chunk_count][cursor_stride]
    global uint* restrict counts) {  // out [cursor_stride]: pairs of each tile
    uint tile = (uint)get_global_id(0) * VW;
    if (tile < tile_count) chunk_starts(cursors, tile_count, chunk_count, tile, counts);
}

kernel void bin_triangles_fill(
    View view, global const InstanceRow* restrict instances,
    global const uint* restrict instance_blocks, global const MeshRow* restrict meshes,
    global const float* restrict vertices, global const uint* restrict indices,
    global const SurfaceMaterial* restrict materials, uint triangle_count,
    global const uint* restrict columns, global const uint* restrict rows, uint some_closed,
    global const uchar* restrict closed,
    global uint* restrict cursors,        // in: starts [chunks][cursor_stride]; used up
    global const uint* restrict offsets,  // [tiles + 1]
    global uint* restrict lists,          // out [capacity]
    uint capacity) {
    SurfaceScene scene = {instances, instance_blocks, meshes, vertices, indices, materials, 0, 0};
    TileWalk walk = {scene, view,   CHUNK_CURSORS(view), offsets, lists, capacity,
                     true,  closed, some_closed != 0};
    WALK_CHUNK(walk);
}
