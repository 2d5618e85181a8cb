// SPDX-License-Identifier: Apache-2.0
// A tile's pixels in a work-item's memory: the triangle of each so far, in strips of VW.
//
// A strip is STRIP_ROWS rows of neighbouring columns, since most triangles are few pixels wide. The
// tile keeps its pixels column by column within the rows of a strip, so a strip that begins at any
// column is one vector in memory.
#ifndef KILOLUX_DEVICE_TILE_STRIPS_H
#define KILOLUX_DEVICE_TILE_STRIPS_H
#include "kernels/surfaces/raster_span.h"
#include "kernels/surfaces/raster_tile.h"

#if VW == 16
#define STRIP_ROWS 2
#define STRIP_COLUMNS 8
#elif VW == 8
#define STRIP_ROWS 2
#define STRIP_COLUMNS 4
#else
#define STRIP_ROWS 1
#define STRIP_COLUMNS VW
#endif
#define TILE_STRIPS (TILE_HEIGHT / STRIP_ROWS)
#define STRIP_ROW_LANES ((TILE_STRIPS + VW - 1) / VW * VW)
// Strips begin at a triangle's first column: the last may end past the tile.
#define STRIP_STRIDE ((TILE_WIDTH + STRIP_COLUMNS) * STRIP_ROWS)
#define strip_lanes_x (lane_numbers / STRIP_ROWS)
#define strip_lanes_y (lane_numbers % STRIP_ROWS)

// For boxes of at least so many strips, the edges decide which of them a triangle touches.
#define FEW_STRIPS 4

// Keys and ids so far, of the tile's pixels; and their rays.
typedef struct Tile {
    float key[TILE_STRIPS * STRIP_STRIDE];
    uint id[TILE_STRIPS * STRIP_STRIDE];
    float ray_x[STRIP_STRIDE];
    float ray_y[TILE_STRIPS][VW];
    float top[STRIP_ROW_LANES];  // ray_y of a row of strips' first row, and of its last
    float bottom[STRIP_ROW_LANES];
    uint x, y;           // of its first pixel, in the planes
    uint width, height;  // of its pixels in the picture
} Tile;

// VW pixels.
typedef struct Strip {
    uint x, y;  // of its first column, in the tile; of its row of strips
} Strip;

static inline uint place_of(Strip s) { return s.y * STRIP_STRIDE + s.x * STRIP_ROWS; }

// The pixels' centres in the picture.
static inline FV centres_x(View view, const Tile* tile, Strip s) {
    return lane_to_float(strip_lanes_x + (tile->x + s.x + view.first_column)) + 0.5f;
}
static inline FV centres_y(View view, const Tile* tile, Strip s) {
    return lane_to_float(strip_lanes_y + (tile->y + s.y * STRIP_ROWS + view.first_row)) + 0.5f;
}

static inline void clear_tile(View view, Tile* tile) {
    Strip s = {0, 0};
    for (s.x = 0; s.x < TILE_WIDTH + STRIP_COLUMNS; s.x += STRIP_COLUMNS) {
        FV x = fma(centres_x(view, tile, s), fv(view.ray.x), fv(view.ray.y));
        lane_store(x, tile->ray_x + s.x * STRIP_ROWS);
    }
    for (s.y = 0; s.y < TILE_STRIPS; ++s.y) {
        FV py = centres_y(view, tile, s);
        lane_store(fma(py, fv(view.ray.z), fv(view.ray.w)), tile->ray_y[s.y]);
        for (s.x = 0; s.x < TILE_WIDTH + STRIP_COLUMNS; s.x += STRIP_COLUMNS) {
            lane_store(far_key(view, centres_x(view, tile, s), py), tile->key + place_of(s));
            lane_store((UV)(0u), tile->id + place_of(s));
        }
    }
    for (s.y = 0; s.y < STRIP_ROW_LANES; ++s.y) {
        tile->top[s.y] = ray_y(view, tile->y + s.y * STRIP_ROWS);
        tile->bottom[s.y] = ray_y(view, tile->y + s.y * STRIP_ROWS + STRIP_ROWS - 1u);
    }
}

// The strips of a tile that a triangle's box touches.
typedef struct StripBox {
    uint x0, x1;  // columns
    uint y0, y1;  // rows of strips; y0 > y1: none
} StripBox;

static inline StripBox strip_box(const Tile* tile, global const RasterRow* t) {
    StripBox out;
    out.x0 = max(interval_first(t->columns), tile->x) - tile->x;
    out.x1 = min(interval_last(t->columns) - tile->x, tile->width - 1u);
    out.y0 = (max(interval_first(t->rows), tile->y) - tile->y) / STRIP_ROWS;
    out.y1 = min(interval_last(t->rows) - tile->y, tile->height - 1u) / STRIP_ROWS;
    return out;
}

// Columns of the tile in each row of strips that a triangle touches; first > last: none.
typedef struct StripSpans {
    int first[STRIP_ROW_LANES];
    int last[STRIP_ROW_LANES];
} StripSpans;

static inline void find_spans(View view, const Tile* tile, global const RasterRow* t, StripBox box,
                              StripSpans* out) {
    RowSpans whole = {fv((float)box.x0), fv((float)box.x1)};
    uint strips = ((box.x1 - box.x0) / STRIP_COLUMNS + 1u) * (box.y1 - box.y0 + 1u);
    for (uint y = box.y0 / VW * VW; y <= box.y1; y += VW) {
        RowSpans s = whole;
        if (strips >= FEW_STRIPS) {
            s = touched_spans(view, t, tile->ray_x[0], lane_load(tile->top + y),
                              lane_load(tile->bottom + y), s);
        }
        lane_store(lane_to_int(min(s.first, fv((float)TILE_WIDTH))), out->first + y);
        lane_store(lane_to_int(max(s.last, fv(-1.0f))), out->last + y);
    }
}

// A triangle's affine functions along a row of strips: x times the ray's x, and the rest.
typedef struct StripEdges {
    FV x[3], plane_x, rest[3], plane_rest;
    FV farthest, nearest;
} StripEdges;

static inline StripEdges edges_of(global const RasterRow* t) {
    StripEdges out;
    for (uint e = 0; e < 3; ++e) out.x[e] = fv(t->edge[3 * e]);
    out.plane_x = fv(t->plane[0]);
    out.farthest = fv(t->farthest);
    out.nearest = fv(t->nearest);
    return out;
}

static inline void begin_strips(const Tile* tile, uint y, global const RasterRow* t,
                                StripEdges* edges) {
    FV ry = lane_load(tile->ray_y[y]);
#pragma unroll
    for (uint e = 0; e < 3; ++e) {
        edges->rest[e] = fma(fv(t->edge[3 * e + 1]), ry, fv(-t->edge[3 * e + 2]));
    }
    edges->plane_rest = fma(fv(t->plane[1]), ry, fv(-t->plane[2]));
}

// The arguments of drawing all triangles of a tile.
typedef struct Canvas {
    const SurfaceScene* scene;
    const View* view;
    Tile* tile;
} Canvas;

// Integers decide where floats are uncertain. It is rare: inlined, it would keep its caller from
// being inlined.
__attribute__((noinline)) static MASK decide_exactly(const SurfaceScene* scene, const View* view,
                                                     uint number, FV rx, FV ry, MASK unsure) {
    ExactTriangle t = exact_triangle(*scene, *view, number);
    float x[VW], y[VW];
    int inside[VW];
    lane_store(rx, x);
    lane_store(ry, y);
    lane_store(unsure, inside);
    for (uint i = 0; i < VW; ++i) {
        if (inside[i] != 0) inside[i] = covers_exactly(&t, (float2)(x[i], y[i])) ? -1 : 0;
    }
    return lane_load(inside);
}

// The pixels of a strip that the triangle covers; past its box there are none.
static inline MASK covered(Canvas c, uint number, const StripEdges* edges, Strip s) {
    FV rx = lane_load(c.tile->ray_x + s.x * STRIP_ROWS);
    FV least = fma(edges->x[0], rx, edges->rest[0]);
    least = min(least, fma(edges->x[1], rx, edges->rest[1]));
    least = min(least, fma(edges->x[2], rx, edges->rest[2]));
    MASK inside = lane_mask(least > fv(1.0f));
    MASK unsure = ~lane_mask(least < fv(-1.0f)) & ~inside;
    if (lane_any(unsure)) {
        inside |=
            decide_exactly(c.scene, c.view, number, rx, lane_load(c.tile->ray_y[s.y]), unsure);
    }
    return inside;
}

static inline FV keys_of(const Tile* tile, const StripEdges* edges, Strip s) {
    FV rx = lane_load(tile->ray_x + s.x * STRIP_ROWS);
    FV key = fma(edges->plane_x, rx, edges->plane_rest);
    return min(max(key, edges->farthest), edges->nearest);
}

// PoCL makes a vstore16 of four stores; these are one.
typedef FV UnalignedFloats __attribute__((aligned(4)));
typedef UV UnalignedUints __attribute__((aligned(4)));

static inline void store_strip(Tile* tile, Strip s, MASK wins, FV key, uint number) {
    UnalignedFloats* keys = (UnalignedFloats*)(tile->key + place_of(s));
    UnalignedUints* ids = (UnalignedUints*)(tile->id + place_of(s));
    *keys = lane_select(wins, key, *keys);
    *ids = select(*ids, (UV)(number + 1u), wins);
}

// The pixels of a strip that a triangle wins which comes in any order and may be cut by the near
// plane.
static inline MASK wins_cut(Canvas c, uint number, const StripEdges* edges, Strip s, FV key) {
    FV old = lane_load(c.tile->key + place_of(s));
    // Background has the number 0 - 1, which is not smaller.
    MASK first =
        lane_mask(key == old) & lane_mask((UV)(number) < lane_load(c.tile->id + place_of(s)) - 1u);
    FV far = far_key(*c.view, centres_x(*c.view, c.tile, s), centres_y(*c.view, c.tile, s));
    MASK behind_near = lane_mask(key <= far + near_from_far(*c.view));
    return covered(c, number, edges, s) & (lane_mask(key > old) | first) & behind_near;
}

// The pixels of a strip that a triangle wins which comes in its order and is not cut by the near
// plane.
static inline MASK wins_whole(Canvas c, uint number, const StripEdges* edges, Strip s, FV key) {
    MASK nearer = lane_mask(key > lane_load(c.tile->key + place_of(s)));
    return covered(c, number, edges, s) & nearer;
}

// The lanes of a strip's row: every STRIP_ROWS-th.
#if STRIP_ROWS == 1
#define ROW_OF_STRIP(v, i) (v)
#elif STRIP_ROWS == 2
#define ROW_OF_STRIP(v, i) ((i) == 0 ? (v).even : (v).odd)
#endif
#if STRIP_COLUMNS == 1
#define store_row(v, p) (*(p) = (v))
#else
#define store_row(v, p) KX_CONCAT(vstore, STRIP_COLUMNS)(v, 0, p)
#endif

static inline void store_tile(View view, const Tile* tile, global uint* ids) {
    uint end = min(tile->x + TILE_WIDTH, view.stride) - tile->x;
    for (uint y = 0; y < tile->height; ++y) {
        global uint* row = ids + (size_t)(tile->y + y) * view.stride + tile->x;
        Strip s = {0, y / STRIP_ROWS};
        for (; s.x < end; s.x += STRIP_COLUMNS) {
            UV strip = lane_load(tile->id + place_of(s));
            store_row(ROW_OF_STRIP(strip, y % STRIP_ROWS), row + s.x);
        }
    }
}

#endif
