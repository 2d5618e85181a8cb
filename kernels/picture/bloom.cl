// SPDX-License-Identifier: Apache-2.0
// Bloom by a pyramid of halved images (Jimenez 2014, "Next Generation Post Processing in Call of
// Duty"): each level is the one above filtered by [1 3 3 1] / 8 both ways; on the way back up a
// level is doubled by the tent [1 3 3 1] / 4 and mixed into the one above. Both filters keep the
// sum of the light, at the borders too where a level's size is even: clamping mirrors the one pixel
// that is missing. One work-item makes VW neighbouring pixels of a row of one plane.
#include "kernels/device/lanes.h"

static inline uint clamped(int i, uint size) { return (uint)clamp(i, 0, (int)size - 1); }

// NaN and negative light do not bloom, and infinite light counts as the largest float that a sum of
// 16 can hold. fmax(), since max() is undefined for NaN.
static inline FV bloomable(FV v) { return fmin(fmax(v, fv(0.0f)), fv(1e36f)); }

// p[0], p[2], p[4] ... Elements by name, since oclgrind 21.10 crashes on vectors joined of halves
// such as (a.even, b.even); compilers make the same shuffles of both.
static inline FV every_second(global const float* p) {
#if VW == 1
    return p[0];
#else
    FV a = lane_load(p), b = lane_load(p + VW);
#if VW == 2
    return (FV)(a.s0, b.s0);
#elif VW == 4
    return (FV)(a.s0, a.s2, b.s0, b.s2);
#elif VW == 8
    return (FV)(a.s0, a.s2, a.s4, a.s6, b.s0, b.s2, b.s4, b.s6);
#else
    return (FV)(a.s0, a.s2, a.s4, a.s6, a.s8, a.sa, a.sc, a.se,  //
                b.s0, b.s2, b.s4, b.s6, b.s8, b.sa, b.sc, b.se);
#endif
#endif
}

// Source pixels at `offset` from twice x .. x + VW - 1, clamped to the row.
static inline FV tap(global const float* row, uint width, uint x, int offset) {
    int first = (int)(x * 2u) + offset;
    if (first >= 0 && first + 2 * VW <= (int)width) return bloomable(every_second(row + first));
    float taps[VW];
    for (int i = 0; i < VW; ++i) taps[i] = row[clamped(first + 2 * i, width)];
    return bloomable(lane_load(taps));
}

// The row filtered at twice the pixels x .. x + VW - 1.
static inline FV filtered_row(global const float* row, uint width, uint x) {
    FV outer = tap(row, width, x, -1) + tap(row, width, x, 2);
    FV inner = tap(row, width, x, 0) + tap(row, width, x, 1);
    return fma(inner, fv(0.375f), outer * 0.125f);
}

kernel void bloom_down(global const float* restrict fine,  // [3][height][stride]
                       uint4 fine_size,                    // width, height, stride [pixel]
                       uint4 coarse_size,
                       global float* restrict coarse) {  // out [3][height][stride]
    uint x = (uint)get_global_id(0) * VW;
    uint y = get_global_id(1);
    uint plane = get_global_id(2);
    global const float* image = fine + plane * fine_size.y * fine_size.z;
    FV rows[4];
    for (int i = 0; i < 4; ++i) {
        rows[i] = filtered_row(image + clamped((int)(2u * y) + i - 1, fine_size.y) * fine_size.z,
                               fine_size.x, x);
    }
    FV sum = fma(rows[1] + rows[2], fv(0.375f), (rows[0] + rows[3]) * 0.125f);
    lane_store(sum, coarse + (plane * coarse_size.y + y) * coarse_size.z + x);
}

// Half as many lanes.
#if VW == 2
#define HALF_LOAD(p) (*(p))
#elif VW == 4
#define HALF_LOAD(p) vload2(0, p)
#elif VW == 8
#define HALF_LOAD(p) vload4(0, p)
#elif VW == 16
#define HALF_LOAD(p) vload8(0, p)
#endif

// The coarse row doubled at pixels x .. x + VW - 1.
static inline FV doubled_row(global const float* row, uint width, uint x) {
#if VW > 1
    if (x > 0u && x / 2u + VW / 2u < width) {  // not at a border: whole loads
        FV near, far;
        near.even = near.odd = HALF_LOAD(row + x / 2u);
        far.even = HALF_LOAD(row + x / 2u - 1u);
        far.odd = HALF_LOAD(row + x / 2u + 1u);
        return fma(near, fv(0.75f), far * 0.25f);
    }
#endif
    float near_taps[VW], far_taps[VW];
    for (uint i = 0; i < VW; ++i) {
        int half_x = (int)((x + i) / 2u);
        near_taps[i] = row[clamped(half_x, width)];
        far_taps[i] = row[clamped(half_x + ((x + i) % 2u != 0u ? 1 : -1), width)];
    }
    return fma(lane_load(near_taps), fv(0.75f), lane_load(far_taps) * 0.25f);
}

kernel void bloom_up(global const float* restrict coarse,  // [3][height][stride]
                     uint4 coarse_size,                    // width, height, stride
                     global const float* fine,             // [3][height][stride]
                     uint4 fine_size,
                     float share,            // of the coarse image in the result
                     global float* mixed) {  // out, as fine; may be fine
    uint x = (uint)get_global_id(0) * VW;
    uint y = get_global_id(1);
    uint plane = get_global_id(2);
    global const float* image = coarse + plane * coarse_size.y * coarse_size.z;
    uint near_row = clamped((int)(y / 2u), coarse_size.y);
    uint far_row = clamped((int)(y / 2u) + (y % 2u != 0u ? 1 : -1), coarse_size.y);
    FV near = doubled_row(image + near_row * coarse_size.z, coarse_size.x, x);
    FV far = doubled_row(image + far_row * coarse_size.z, coarse_size.x, x);
    FV wide = fma(near, fv(0.75f), far * 0.25f);
    uint pixel = (plane * fine_size.y + y) * fine_size.z + x;
    lane_store(fma(wide, fv(share), lane_load(fine + pixel) * (1.0f - share)), mixed + pixel);
}
