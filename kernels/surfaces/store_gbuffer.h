// SPDX-License-Identifier: Apache-2.0
// Writes a block of pixels to a G-buffer in OpenCL C, as kernels/shared/store.h packs them.
#ifndef KILOLUX_DEVICE_STORE_GBUFFER_H
#define KILOLUX_DEVICE_STORE_GBUFFER_H
#include "kernels/device/lanes.h"
#include "kernels/device/srgb.h"
#include "kernels/shared/gbuffer.h"
#include "kernels/shared/surface.h"
#include "kernels/shared/view.h"
#include "kernels/surfaces/block.h"

// The target of pixels.
typedef struct GBufferTarget {
    global uchar* bytes;
    GBufferLayout layout;
    View view;
    SrgbTable table;
    Pixels pixels;
    MASK shown;  // other pixels become 0 in every plane
} GBufferTarget;

static inline global uchar* plane_of(GBufferTarget to, uint plane) {
    return to.bytes + to.layout.offset_bytes[plane];
}

static inline void store_plane_float(GBufferTarget to, uint plane, FV value) {
    FV kept = lane_select(to.shown, value, fv(0.0f));
    global float* at = (global float*)plane_of(to, plane) + to.pixels.first;
    STORE_BLOCK(kept, at, to.pixels, to.view.stride);
}

static inline void store_plane_uint(GBufferTarget to, uint plane, UV value) {
    UV kept = select((UV)(0u), value, to.shown);
    global uint* at = (global uint*)plane_of(to, plane) + to.pixels.first;
    STORE_BLOCK(kept, at, to.pixels, to.view.stride);
}

static inline void store_plane_byte(GBufferTarget to, uint plane, UV value) {
    UV kept = select((UV)(0u), value, to.shown);
    global uchar* at = plane_of(to, plane) + to.pixels.first;
    STORE_BLOCK(lane_to_uchar(kept), at, to.pixels, to.view.stride);
}

#if GBUFFER == GBUFFER_HALF
static inline void store_plane_half(GBufferTarget to, uint plane, FV value) {
    FV kept = lane_select(to.shown, value, fv(0.0f));
    global half* at = (global half*)plane_of(to, plane) + to.pixels.first;
    STORE_BLOCK_HALF(kept, at, to.pixels, to.view.stride);
}
#elif GBUFFER == GBUFFER_OCT_2X4
static inline void store_plane_row(GBufferTarget to, uint plane, FV x, FV y, FV z, FV w) {
    float lanes[4][VW];
    lane_store(lane_select(to.shown, x, fv(0.0f)), lanes[0]);
    lane_store(lane_select(to.shown, y, fv(0.0f)), lanes[1]);
    lane_store(lane_select(to.shown, z, fv(0.0f)), lanes[2]);
    lane_store(lane_select(to.shown, w, fv(0.0f)), lanes[3]);
    global float4* rows = (global float4*)plane_of(to, plane) + to.pixels.first;
#if BLOCK_PIXELS
    for (uint i = 0; i < to.pixels.rows * BLOCK_COLUMNS; ++i) {
        rows[i / BLOCK_COLUMNS * to.view.stride + i % BLOCK_COLUMNS] =
            (float4)(lanes[0][i], lanes[1][i], lanes[2][i], lanes[3][i]);
    }
#else
    for (uint i = 0; i < VW; ++i) {
        rows[i] = (float4)(lanes[0][i], lanes[1][i], lanes[2][i], lanes[3][i]);
    }
#endif
}
#endif

#define emissive_scale_of(to) (to).layout.emissive_scale
#define encode_srgb(to, v) srgb_code((to).table, v)

#include "kernels/shared/store.h"
#endif
