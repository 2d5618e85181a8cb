// SPDX-License-Identifier: Apache-2.0
// The tiles that triangles are sorted into: TILE_WIDTH x TILE_HEIGHT pixels of the planes.
#ifndef KILOLUX_DEVICE_RASTER_TILE_H
#define KILOLUX_DEVICE_RASTER_TILE_H
#include "kernels/shared/view.h"

#ifndef TILE_WIDTH
#define TILE_WIDTH 64
#endif
#ifndef TILE_HEIGHT
#define TILE_HEIGHT 64
#endif

static inline uint raster_tiles_x(View view) { return (view.width + TILE_WIDTH - 1) / TILE_WIDTH; }
static inline uint raster_tiles_y(View view) {
    return (view.height + TILE_HEIGHT - 1) / TILE_HEIGHT;
}

// Numbers from first to last, packed: first | last << 16; first > last: none.
static inline uint interval_of(uint first, uint last) { return first | last << 16; }
#define EMPTY_INTERVAL 1u
static inline uint interval_first(uint interval) { return interval & 0xffffu; }
static inline uint interval_last(uint interval) { return interval >> 16; }
static inline uint interval_count(uint interval) {
    return interval_last(interval) + 1u - interval_first(interval);
}

// A triangle's number in a tile's list, with this bit where alpha cuts it.
#define MASKED_TRIANGLE 0x80000000u
#endif
