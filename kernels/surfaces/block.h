// SPDX-License-Identifier: Apache-2.0
// Blocks of VW pixels, as square as possible: they show fewer triangles than a row of as many, and
// their texels lie closer together. With one lane a block is a pixel.
#ifndef KILOLUX_DEVICE_BLOCK_H
#define KILOLUX_DEVICE_BLOCK_H
#include "kernels/device/lanes.h"
#include "kernels/device/pixels.h"

#if VW >= 8
#define BLOCK_COLUMNS 4
#elif VW == 4
#define BLOCK_COLUMNS 2
#else
#define BLOCK_COLUMNS VW
#endif
#define BLOCK_ROWS (VW / BLOCK_COLUMNS)

#if BLOCK_PIXELS
// The block of the work-item whose row of VW pixels would begin at (x, y): a tile has as many
// blocks. Lanes go along its rows.
static inline Pixels block_pixels(View view, uint x, uint y) {
    uint column = (y % BLOCK_ROWS * FINE_TILE + x % FINE_TILE) / BLOCK_ROWS;
    uint first_x = x / FINE_TILE * FINE_TILE + column;
    uint first_y = y - y % BLOCK_ROWS;
    Pixels pixels;
    pixels.x = lane_to_float(lane_numbers % BLOCK_COLUMNS + picture_column(view, first_x)) + 0.5f;
    pixels.y = lane_to_float(lane_numbers / BLOCK_COLUMNS + picture_row(view, first_y)) + 0.5f;
    pixels.first = first_y * view.stride + first_x;
    pixels.rows = min(view.height - min(first_y, view.height), (uint)BLOCK_ROWS);
    return pixels;
}

static inline MASK within_picture(View view, Pixels pixels) {
    MASK above = lane_mask(lane_numbers < (UV)(pixels.rows * BLOCK_COLUMNS));
    return within_width(view, pixels) & above;
}

// Loads the elements at p and below; rows beyond the plane repeat the first.
static inline UV load_block(global const uint* p, Pixels pixels, uint stride) {
    uint to_1 = pixels.rows > 1u ? stride : 0u;
#if BLOCK_ROWS == 4
    uint to_2 = pixels.rows > 2u ? 2u * stride : 0u;
    uint to_3 = pixels.rows > 3u ? 3u * stride : 0u;
    return (UV)(vload4(0, p), vload4(0, p + to_1), vload4(0, p + to_2), vload4(0, p + to_3));
#elif VW > 2
    return (UV)(KX_CONCAT(vload, BLOCK_COLUMNS)(0, p),
                KX_CONCAT(vload, BLOCK_COLUMNS)(0, p + to_1));
#else
    return lane_load(p);
#endif
}

// Stores rows of lanes by `store`, which takes BLOCK_COLUMNS elements, to p and below.
#if BLOCK_ROWS == 4
#define STORE_ROWS(store, v, p, pixels, stride)                    \
    store((v).lo.lo, p);                                           \
    if ((pixels).rows > 1u) store((v).lo.hi, (p) + (stride));      \
    if ((pixels).rows > 2u) store((v).hi.lo, (p) + 2u * (stride)); \
    if ((pixels).rows > 3u) store((v).hi.hi, (p) + 3u * (stride))
#elif BLOCK_ROWS == 2
#define STORE_ROWS(store, v, p, pixels, stride) \
    store((v).lo, p);                           \
    if ((pixels).rows > 1u) store((v).hi, (p) + (stride))
#else
#define STORE_ROWS(store, v, p, pixels, stride) store(v, p)
#endif
#else
#define block_pixels(view, x, y) row_pixels(view, x, y)
#define within_picture(view, pixels) within_width(view, pixels)
#define load_block(p, pixels, stride) lane_load(p)
#define STORE_ROWS(store, v, p, pixels, stride) store(v, p)
#endif

#if VW == 1
#define STORE_ELEMENTS(v, p) lane_store(v, p)
#define STORE_HALVES(v, p) vstore_half_rte(v, 0, p)
#else
#define STORE_ELEMENTS(v, p) KX_CONCAT(vstore, BLOCK_COLUMNS)(v, 0, p)
#define STORE_HALVES(v, p) KX_CONCAT(KX_CONCAT(vstore_half, BLOCK_COLUMNS), _rte)(v, 0, p)
#endif
#define STORE_BLOCK(v, p, pixels, stride) STORE_ROWS(STORE_ELEMENTS, v, p, pixels, stride)
#define STORE_BLOCK_HALF(v, p, pixels, stride) STORE_ROWS(STORE_HALVES, v, p, pixels, stride)
#endif
