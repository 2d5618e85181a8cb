// SPDX-License-Identifier: Apache-2.0
// VW pixels as a block, as square as can be: it shows fewer triangles than a row of as many, and
// their texels lie closer together.
#ifndef KILOLUX_DEVICE_BLOCK_H
#define KILOLUX_DEVICE_BLOCK_H
#include "kernels/device/lanes.h"
#include "kernels/device/pixels.h"

#if VW == 16
#define BLOCK_COLUMNS 4
#elif VW == 8
#define BLOCK_COLUMNS 4
#elif VW == 4
#define BLOCK_COLUMNS 2
#else
#define BLOCK_COLUMNS VW
#endif
#define BLOCK_ROWS (VW / BLOCK_COLUMNS)
#define TILE_ITEMS (FINE_TILE / VW)  // work-items of a tile's row

// Lanes go along the block's rows. `pixels.first` is the first one's place.
typedef struct Block {
    Pixels pixels;
    uint stride;  // of the planes [pixel]
    uint rows;    // that the planes have; 0: the block lies below them
} Block;

// The block of the work-item (item, row) among those that have VW pixels of a row each: a tile has
// as many blocks.
static inline Block block_of_item(View view, uint item, uint row) {
    uint column = (row % BLOCK_ROWS * TILE_ITEMS + item % TILE_ITEMS) * BLOCK_COLUMNS;
    uint x = item / TILE_ITEMS * FINE_TILE + column;
    uint y = row - row % BLOCK_ROWS;
    Block out;
    out.pixels.x = lane_to_float(lane_numbers % BLOCK_COLUMNS + x) + 0.5f;
    out.pixels.y = lane_to_float(lane_numbers / BLOCK_COLUMNS + y + view.first_row) + 0.5f;
    out.pixels.first = y * view.stride + x;
    out.stride = view.stride;
    out.rows = min(max(view.height, y) - y, (uint)BLOCK_ROWS);
    return out;
}

// The lanes that the picture has.
static inline MASK within_picture(View view, Block block) {
    MASK above = lane_mask(lane_numbers < (UV)(block.rows * BLOCK_COLUMNS));
    return within_width(view, block.pixels) & above;
}

// The elements of a plane; of rows that it does not have, those of row 0.
static inline UV load_block(global const uint* plane, Block block) {
    global const uint* p = plane + block.pixels.first;
#if BLOCK_ROWS == 1
    return lane_load(p);
#else
    uint to_1 = block.rows > 1u ? block.stride : 0u;
#if VW == 16
    uint to_2 = block.rows > 2u ? 2u * block.stride : 0u;
    uint to_3 = block.rows > 3u ? 3u * block.stride : 0u;
    return (UV)(vload4(0, p), vload4(0, p + to_1), vload4(0, p + to_2), vload4(0, p + to_3));
#else
    return (UV)(KX_CONCAT(vload, BLOCK_COLUMNS)(0, p),
                KX_CONCAT(vload, BLOCK_COLUMNS)(0, p + to_1));
#endif
#endif
}

// Stores rows of lanes by `store`, which takes BLOCK_COLUMNS elements, to p and what lies below.
#if BLOCK_ROWS == 1
#define STORE_ROWS(store, v, p, block) store(v, p)
#elif BLOCK_ROWS == 2
#define STORE_ROWS(store, v, p, block) \
    store((v).lo, p);                  \
    if ((block).rows > 1u) store((v).hi, (p) + (block).stride)
#else
#define STORE_ROWS(store, v, p, block)                                  \
    store((v).lo.lo, p);                                                \
    if ((block).rows > 1u) store((v).lo.hi, (p) + (block).stride);      \
    if ((block).rows > 2u) store((v).hi.lo, (p) + 2u * (block).stride); \
    if ((block).rows > 3u) store((v).hi.hi, (p) + 3u * (block).stride)
#endif
#if VW == 1
#define STORE_ELEMENTS(v, p) (*(p) = (v))
#define STORE_HALVES(v, p) vstore_half_rte(v, 0, p)
#else
#define STORE_ELEMENTS(v, p) KX_CONCAT(vstore, BLOCK_COLUMNS)(v, 0, p)
#define STORE_HALVES(v, p) KX_CONCAT(KX_CONCAT(vstore_half, BLOCK_COLUMNS), _rte)(v, 0, p)
#endif
#define STORE_BLOCK(v, p, block) STORE_ROWS(STORE_ELEMENTS, v, p, block)
#define STORE_BLOCK_HALF(v, p, block) STORE_ROWS(STORE_HALVES, v, p, block)
#endif
