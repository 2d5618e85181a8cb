// SPDX-License-Identifier: Apache-2.0
// The VW pixels of a work-item. With ORDERED_PIXELS they may be any of a tile's, with BLOCK_PIXELS
// they are a block (block.h), else they are neighbours in a row.
#ifndef KILOLUX_DEVICE_PIXELS_H
#define KILOLUX_DEVICE_PIXELS_H
#include "kernels/device/lanes.h"
#include "kernels/shared/cluster_grid.h"
#include "kernels/shared/view.h"

#ifndef ORDERED_PIXELS
#define ORDERED_PIXELS 0
#endif
#ifndef BLOCK_PIXELS
#define BLOCK_PIXELS 0
#endif

// Where VW pixels are.
typedef struct Pixels {
    FV x, y;     // centres in the picture [pixel]
    uint first;  // lane 0's place in a plane
#if BLOCK_PIXELS
    uint rows;  // of the block that a plane has; 0: it lies below
#endif
#if ORDERED_PIXELS
    bool in_row;     // lane i's place is first + i
    uint place[VW];  // each lane's place in a plane
#endif
} Pixels;

// PLACE(i, pixels): lane i's place in a plane. PLANE_AT: the plane's element there.
#if ORDERED_PIXELS
#define PLACE(i, pixels) (pixels).place[i]
#define LOAD_PLANE(T, plane, pixels) \
    ((pixels).in_row ? lane_load((plane) + (pixels).first) : LANES(T, PLANE_AT, plane, pixels))
#else
#define PLACE(i, pixels) ((pixels).first + (i))
#define LOAD_PLANE(T, plane, pixels) lane_load((plane) + (pixels).first)
#endif
#define PLANE_AT(i, plane, pixels) (plane)[PLACE(i, pixels)]

// VW neighbours of a row of the planes from (x, y) on.
static inline Pixels row_pixels(View view, uint x, uint y) {
    Pixels pixels;
    pixels.x = lane_to_float(lane_numbers + picture_column(view, x)) + 0.5f;
    pixels.y = fv((float)picture_row(view, y) + 0.5f);
    pixels.first = y * view.stride + x;
#if ORDERED_PIXELS
    pixels.in_row = true;
    for (uint i = 0; i < VW; ++i) pixels.place[i] = pixels.first + i;
#endif
    return pixels;
}

// Rows of a fine tile that the planes have.
static inline uint rows_of_tile(View view, uint tile_y) {
    return min((uint)FINE_TILE, view.height - tile_y * FINE_TILE);
}

#if ORDERED_PIXELS
// The VW pixels that `order` names, of the tile whose first pixel is (tile_x, tile_y): row *
// FINE_TILE + column each.
static inline Pixels ordered_pixels(View view, uint tile_x, uint tile_y,
                                    global const uchar* order) {
    Pixels pixels;
    UV code = KX_CONCAT(convert_, UV)(lane_load(order));
    UV x = code % FINE_TILE;
    UV y = code / FINE_TILE;
    pixels.x = lane_to_float(x + picture_column(view, tile_x)) + 0.5f;
    pixels.y = lane_to_float(y + picture_row(view, tile_y)) + 0.5f;
    UV place = (y + tile_y) * view.stride + x + tile_x;
    lane_store(place, pixels.place);
    pixels.first = pixels.place[0];
    pixels.in_row = !lane_any(lane_mask(place != lane_numbers + pixels.first));
    return pixels;
}

// VW pixels of a tile from `place` in its order on. `order`: of all tiles.
static inline Pixels pixels_of_tile(View view, uint tile, uint place, global const uchar* order) {
    uint tiles_x = fine_tiles_x(view);
    return ordered_pixels(view, tile % tiles_x * FINE_TILE, tile / tiles_x * FINE_TILE,
                          order + tile * FINE_TILE_PIXELS + place);
}

// Place in its tile's order of the first pixel of the work-item at (x, y).
static inline uint place_of_item(uint x, uint y) {
    return y % FINE_TILE * FINE_TILE + x % FINE_TILE;
}

// The pixels of the work-item at (x, y). `order`: of all tiles.
static inline Pixels pixels_of_item(View view, uint x, uint y, global const uchar* order) {
    return ordered_pixels(
        view, x / FINE_TILE * FINE_TILE, y / FINE_TILE * FINE_TILE,
        order + fine_tile_of(view, x, y) * FINE_TILE_PIXELS + place_of_item(x, y));
}
#endif

// The first pixel of a work-item and its tile. A work-item below the planes has none.
typedef struct ItemPlace {
    uint x, y;
    bool inside;
    uint tile;
} ItemPlace;

static inline ItemPlace place_in_planes(View view) {
    ItemPlace at;
    at.x = (uint)get_global_id(0) * VW;
    at.y = get_global_id(1);
    at.inside = at.y < view.height;
    at.tile = fine_tile_of(view, at.x, at.y);
    return at;
}

static inline MASK within_width(View view, Pixels pixels) {
    return lane_mask(pixels.x < fv((float)picture_column(view, view.width)));
}
#endif
