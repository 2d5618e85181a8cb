// SPDX-License-Identifier: Apache-2.0
// Sets up triangles and lists those of every tile of the picture: a counting sort of (triangle,
// tile) pairs.
//
//   bin_triangles_set_up  triangles -> rows and boxes of tiles, and pairs by (chunk of triangles,
//                         tile); none where no pixel can show it: turned away, outside, between
//                         pixels' centres
//   bin_triangles_offset  (GROUP == 1) where each chunk's pairs begin within each tile, and its
//                         total
//   (prefix_sum over tiles)
//   bin_triangles_fill    writes the triangles' numbers
//
// GROUP == 1: a work-item walks a chunk, VW triangles at once, and lists ascend. Else a work-group
// takes GROUP triangles; set-up counts each tile's pairs up, filling counts them down to 0, so that
// the next picture needs no clear, and lists have any order. The raster's result does not depend on
// it, since the first by number of equally near triangles wins.
#ifndef GROUP
#define GROUP 1
#endif
#include "kernels/device/arguments.h"
#include "kernels/device/chunk_starts.h"
#include "kernels/device/scan_group.h"
#include "kernels/surfaces/raster_set_up.h"
#include "kernels/surfaces/raster_span.h"
#include "kernels/surfaces/raster_tile.h"

// For boxes of at least so many tiles, the edges decide which of them a triangle touches.
#define FEW_TILES 4u
// Takes slots in so many tiles before it fills any, since each waits for memory.
#if GROUP == 1
#define TILES_AT_ONCE 1u
#else
#define TILES_AT_ONCE 4u
#endif

// A triangle and the tiles that its pixels' box touches.
typedef struct TileBox {
    uint number;         // with MASKED_TRIANGLE
    uint columns, rows;  // intervals of tiles
} TileBox;

static inline TileBox tile_box(const SetUpLanes* s, uint lane, uint number) {
    TileBox out;
    out.number = s->masked[lane] != 0 ? number | MASKED_TRIANGLE : number;
    out.columns = interval_of(s->x0[lane] / TILE_WIDTH, s->x1[lane] / TILE_WIDTH);
    out.rows = interval_of(s->y0[lane] / TILE_HEIGHT, s->y1[lane] / TILE_HEIGHT);
    return out;
}

static inline void store_box(TileBox box, global uint* boxes) {
    vstore4((uint4)(box.number, box.columns, box.rows, 0u), 0, boxes);
}
static inline TileBox load_box(global const uint* boxes) {
    uint4 b = vload4(0, boxes);
    TileBox out = {b.x, b.y, b.z};
    return out;
}

// The target of pairs: counted, or filled in.
typedef struct TileWalk {
    View view;
    global const RasterRow* triangles;
    global uint* cursors;        // of this chunk, or of all [tiles]
    global const uint* offsets;  // [tiles + 1]; fill only
    global uint* lists;          // fill only
    uint capacity;               // of lists
    bool fill;
    global const uchar* closed;  // [tiles]: 1 where no triangle is needed
    bool some_closed;            // else nothing is read of `closed`
} TileWalk;

#define NO_SLOT 0xffffffffu

// The triangle's place among those of the tile.
static inline uint take_slot(TileWalk walk, uint tile) {
    if (walk.some_closed && walk.closed[tile] != 0) return NO_SLOT;
#if GROUP == 1
    return walk.cursors[tile]++;
#else
    return walk.fill ? atomic_dec(walk.cursors + tile) - 1u : atomic_inc(walk.cursors + tile);
#endif
}

static inline void fill_slot(TileWalk walk, uint tile, uint slot, uint number) {
    if (!walk.fill || slot == NO_SLOT) return;
    uint place = walk.offsets[tile] + slot;
    if (place < walk.capacity) walk.lists[place] = number;
}

// The columns of tiles that hold all pixels that the triangle covers, in VW rows of tiles.
static inline void touched_columns(TileWalk walk, TileBox box, uint first_row, uint* columns) {
    if (interval_count(box.columns) * interval_count(box.rows) < FEW_TILES) {
        for (uint i = 0; i < VW; ++i) columns[i] = box.columns;
        return;
    }
    UV y = (lane_numbers + first_row) * TILE_HEIGHT;
    RowSpans s = {fv((float)(interval_first(box.columns) * TILE_WIDTH)),
                  fv((float)(interval_last(box.columns) * TILE_WIDTH + TILE_WIDTH - 1u))};
    s = touched_spans(walk.view, walk.triangles + (box.number & ~MASKED_TRIANGLE),
                      fma((float)walk.view.first_column + 0.5f, walk.view.ray.x, walk.view.ray.y),
                      rays_y(walk.view, y), rays_y(walk.view, y + (TILE_HEIGHT - 1u)), s);
    MASK none = ~lane_mask(s.first <= s.last);
    UV first = lane_to_uint(lane_select(none, fv(0.0f), s.first)) / TILE_WIDTH;
    UV last = lane_to_uint(lane_select(none, fv(0.0f), s.last)) / TILE_WIDTH;
    lane_store(select(first | last << 16, (UV)(EMPTY_INTERVAL), none), columns);
}

// Some columns of a row of tiles.
static inline void walk_columns(TileWalk walk, uint number, uint row, uint columns) {
    if (columns == EMPTY_INTERVAL) return;
    uint first = row * raster_tiles_x(walk.view) + interval_first(columns);
    uint end = first + interval_count(columns);
    for (uint tile = first; tile < end; tile += TILES_AT_ONCE) {
        uint slots[TILES_AT_ONCE];
#pragma unroll
        for (uint i = 0; i < TILES_AT_ONCE; ++i) {
            slots[i] = tile + i < end ? take_slot(walk, tile + i) : NO_SLOT;
        }
#pragma unroll
        for (uint i = 0; i < TILES_AT_ONCE; ++i) fill_slot(walk, tile + i, slots[i], number);
    }
}

#if GROUP == 1
static inline void walk_box(TileWalk walk, TileBox box) {
    uint last = interval_last(box.rows);
    for (uint row = interval_first(box.rows); row <= last; row += VW) {
        uint columns[VW];
        touched_columns(walk, box, row, columns);
        uint rows = min(last + 1u - row, (uint)VW);
        for (uint i = 0; i < rows; ++i) walk_columns(walk, box.number, row + i, columns[i]);
    }
}

// Triangles of a chunk, in whole vectors.
static inline uint chunk_begin(uint triangle_count, uint chunk) {
    ulong vectors = (triangle_count + VW - 1u) / VW;
    return (uint)(vectors * chunk / get_num_groups(0)) * VW;
}

// Keeps the visible ones of VW triangles. Returns the place of the next box.
static inline uint keep_triangles(const SetUp* s, uint first, TileWalk walk,
                                  global RasterRow* triangles, global uint* boxes, uint next) {
    SetUpLanes lanes;
    store_lanes(s, &lanes);
    for (uint lane = 0; lane < VW; ++lane) {
        if (lanes.kept[lane] == 0) continue;
        triangles[first + lane] = raster_row(&lanes, lane);
        TileBox box = tile_box(&lanes, lane, first + lane);
        store_box(box, boxes + 4 * (size_t)next++);
        walk_box(walk, box);
    }
    return next;
}
#else
// Walks the boxes of all items, row by row, so that large ones keep no item longer than small ones.
// `ends`, `boxes`: [GROUP].
static inline void walk_group(TileWalk walk, TileBox mine, local ulong* ends,
                              local TileBox* boxes) {
    uint item = get_local_id(0);
    bool kept = mine.columns != EMPTY_INTERVAL;
    boxes[item] = mine;
    scan_group(kept ? interval_count(mine.rows) : 0u, ends);  // and all boxes are there
    uint total = (uint)ends[GROUP - 1];
    for (uint i = item; i < total; i += GROUP) {
        uint first = 0, last = GROUP - 1;  // of the items that row i may be of
        while (first < last) {
            uint middle = (first + last) / 2u;
            if (ends[middle] > i) {
                last = middle;
            } else {
                first = middle + 1u;
            }
        }
        TileBox box = boxes[first];
        uint before = first == 0u ? 0u : (uint)ends[first - 1u];
        uint row = interval_first(box.rows) + i - before;
        uint columns;
        touched_columns(walk, box, row, &columns);
        walk_columns(walk, box.number, row, columns);
    }
}
#endif

// Binning of host/stages/surfaces/bin_triangles.cpp.
// some_closed: 0: `closed` is not read. closed: [tiles]: 1 where no triangle is needed. boxes:
// [triangle_count][4]: TileBox; GROUP == 1: of kept ones, from each chunk's beginning on; else by
// number. kept: [chunks]: kept triangles; GROUP == 1 only. cursors: GROUP == 1:
// [chunks][cursor_stride]: pairs, then starts, which filling uses up; else [tiles]: pairs, 0 before
// and after.
#define BINNING_ARGS(access)                                                    \
    uint triangle_count, uint some_closed, global const uchar *restrict closed, \
        global access uint *restrict boxes, global access uint *restrict kept,  \
        global uint *restrict cursors

kernel void bin_triangles_set_up(View view, SCENE_ARGS,
                                 global RasterRow* triangles,  // out [triangle_count]: kept ones,
                                                               // by number
                                 BINNING_ARGS()) {             // out: boxes, kept, cursors
    SurfaceScene scene = SCENE_OF_ARGS;
    uint tiles = raster_tiles_x(view) * raster_tiles_y(view);
#if GROUP == 1
    uint chunk = get_group_id(0);
    TileWalk walk = {view,  triangles, cursors + chunk * cursor_stride(tiles),
                     0,     0,         0u,
                     false, closed,    some_closed != 0u};
    for (uint i = 0; i < cursor_stride(tiles); ++i) walk.cursors[i] = 0u;
    uint begin = chunk_begin(triangle_count, chunk);
    uint end = chunk_begin(triangle_count, chunk + 1u);
    uint next = begin;
    for (uint first = begin; first < end; first += VW) {
        UV numbers = lane_numbers + first;
        SetUp s = set_up_triangles(scene, view, numbers, lane_mask(numbers < (UV)(triangle_count)));
        if (lane_any(s.kept)) next = keep_triangles(&s, first, walk, triangles, boxes, next);
    }
    kept[chunk] = next - begin;
#else
    local ulong ends[GROUP];
    local TileBox shared_boxes[GROUP];
    TileWalk walk = {view, triangles, cursors, 0, 0, 0u, false, closed, some_closed != 0u};
    uint number = get_global_id(0);
    TileBox box = {number, EMPTY_INTERVAL, EMPTY_INTERVAL};
    if (number < triangle_count) {
        SetUp s = set_up_triangles(scene, view, number, -1);
        if (s.kept != 0) {
            SetUpLanes lanes;
            store_lanes(&s, &lanes);
            triangles[number] = raster_row(&lanes, 0);
            box = tile_box(&lanes, 0, number);
        }
        store_box(box, boxes + 4 * (size_t)number);
    }
    barrier(CLK_GLOBAL_MEM_FENCE);  // the group's rows are there for all of its items
    walk_group(walk, box, ends, shared_boxes);
#endif
}

// One work-item for VW tiles.
kernel void bin_triangles_offset(
    uint tile_count, uint chunk_count,
    global uint* restrict cursors,   // in: pairs, out: starts [chunk_count][cursor_stride]
    global uint* restrict counts) {  // out [cursor_stride]: pairs of each tile
    uint tile = (uint)get_global_id(0) * VW;
    if (tile < tile_count) chunk_starts(cursors, tile_count, chunk_count, tile, counts);
}

kernel void bin_triangles_fill(View view, BINNING_ARGS(const),  // as bin_triangles_set_up made them
                               TRIANGLE_LIST_ARGS()) {          // out: lists
#if GROUP == 1
    uint chunk = get_group_id(0);
    uint stride = cursor_stride(raster_tiles_x(view) * raster_tiles_y(view));
    TileWalk walk = {view, triangles, cursors + chunk * stride, offsets, lists, capacity,
                     true, closed,    some_closed != 0u};
    uint begin = chunk_begin(triangle_count, chunk);
    for (uint i = begin; i < begin + kept[chunk]; ++i) {
        walk_box(walk, load_box(boxes + 4 * (size_t)i));
    }
#else
    local ulong ends[GROUP];
    local TileBox shared_boxes[GROUP];
    TileWalk walk = {view,     triangles, cursors, offsets,          lists,
                     capacity, true,      closed,  some_closed != 0u};
    // Neighbours are alike: a group takes triangles far apart, so that no group has all large ones.
    uint number = (uint)(get_local_id(0) * get_num_groups(0) + get_group_id(0));
    TileBox box = {number, EMPTY_INTERVAL, EMPTY_INTERVAL};
    if (number < triangle_count) box = load_box(boxes + 4 * (size_t)number);
    walk_group(walk, box, ends, shared_boxes);
#endif
}
