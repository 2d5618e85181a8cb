// SPDX-License-Identifier: Apache-2.0
// Any VW float4 of an array, by component.
#ifndef KILOLUX_DEVICE_GATHER_ROWS_H
#define KILOLUX_DEVICE_GATHER_ROWS_H
#include "kernels/device/lanes.h"

typedef struct LaneRows {
    FV x, y, z, w;
} LaneRows;

#if VW >= 4
typedef struct FourRows {
    float4 x, y, z, w;
} FourRows;

// Rows are loaded whole and turned within registers: a vector that is read where its lanes have
// just been written one by one waits until all of them have reached the cache.
static inline FourRows gather_four_rows(global const float4* rows, const uint* index) {
    float4 a = rows[index[0]];
    float4 b = rows[index[1]];
    float4 c = rows[index[2]];
    float4 d = rows[index[3]];
    float4 ab_xy = (float4)(a.x, b.x, a.y, b.y);
    float4 ab_zw = (float4)(a.z, b.z, a.w, b.w);
    float4 cd_xy = (float4)(c.x, d.x, c.y, d.y);
    float4 cd_zw = (float4)(c.z, d.z, c.w, d.w);
    FourRows out;
    out.x = (float4)(ab_xy.lo, cd_xy.lo);
    out.y = (float4)(ab_xy.hi, cd_xy.hi);
    out.z = (float4)(ab_zw.lo, cd_zw.lo);
    out.w = (float4)(ab_zw.hi, cd_zw.hi);
    return out;
}
#endif

// rows[index[i]] in lane i.
static inline LaneRows gather_rows(global const float4* rows, const uint* index) {
    LaneRows out;
#if VW == 16
    FourRows r0 = gather_four_rows(rows, index);
    FourRows r1 = gather_four_rows(rows, index + 4);
    FourRows r2 = gather_four_rows(rows, index + 8);
    FourRows r3 = gather_four_rows(rows, index + 12);
    out.x = (FV)(r0.x, r1.x, r2.x, r3.x);
    out.y = (FV)(r0.y, r1.y, r2.y, r3.y);
    out.z = (FV)(r0.z, r1.z, r2.z, r3.z);
    out.w = (FV)(r0.w, r1.w, r2.w, r3.w);
#elif VW == 8
    FourRows r0 = gather_four_rows(rows, index);
    FourRows r1 = gather_four_rows(rows, index + 4);
    out.x = (FV)(r0.x, r1.x);
    out.y = (FV)(r0.y, r1.y);
    out.z = (FV)(r0.z, r1.z);
    out.w = (FV)(r0.w, r1.w);
#elif VW == 4
    FourRows r = gather_four_rows(rows, index);
    out.x = r.x;
    out.y = r.y;
    out.z = r.z;
    out.w = r.w;
#else
#define ROW_X(i) rows[index[i]].x
#define ROW_Y(i) rows[index[i]].y
#define ROW_Z(i) rows[index[i]].z
#define ROW_W(i) rows[index[i]].w
    out.x = LANES(FV, ROW_X);
    out.y = LANES(FV, ROW_Y);
    out.z = LANES(FV, ROW_Z);
    out.w = LANES(FV, ROW_W);
#undef ROW_X
#undef ROW_Y
#undef ROW_Z
#undef ROW_W
#endif
    return out;
}
#endif
