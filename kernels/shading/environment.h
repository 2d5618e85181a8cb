// SPDX-License-Identifier: Apache-2.0
// MapTexels of an environment by direction: float[height][width][3], longitude by latitude, its
// middle column towards -Z, its first row towards +Y.
#ifndef KILOLUX_DEVICE_ENVIRONMENT_H
#define KILOLUX_DEVICE_ENVIRONMENT_H
#include "kernels/device/lanes.h"
#include "kernels/shared/view.h"

#define HALF_PI 1.57079633f
#define PI 3.14159265f

// atan(x) for x in [0, 1], absolute error 2e-8 (Abramowitz and Stegun, 4.4.49): atan2() differs
// between devices and lane widths.
static inline FV atan_of_unit(FV x) {
    FV x2 = x * x;
    FV p = fma(fv(0.0028662257f), x2, fv(-0.0161657367f));
    p = fma(p, x2, fv(0.0429096138f));
    p = fma(p, x2, fv(-0.0752896400f));
    p = fma(p, x2, fv(0.1065626393f));
    p = fma(p, x2, fv(-0.1420889944f));
    p = fma(p, x2, fv(0.1999355085f));
    p = fma(p, x2, fv(-0.3333314528f));
    return fma(p * x2, x, x);
}

// Angle of (x, y) from the x axis, -pi to pi; 0 for the zero vector.
static inline FV angle_of(FV y, FV x) {
    FV across = fabs(x), up = fabs(y);
    FV longer = max(across, up);
    FV a = atan_of_unit(min(across, up) / lane_select(longer > fv(0.0f), longer, fv(1.0f)));
    a = lane_select(up > across, fv(HALF_PI) - a, a);
    a = lane_select(x < fv(0.0f), fv(PI) - a, a);
    return lane_select(y < fv(0.0f), -a, a);
}

// World direction of a direction of view space.
static inline FV3 rotate_to_world(View view, FV3 p) {
    float4 x = view.view_from_world_x;
    float4 y = view.view_from_world_y;
    float4 z = view.view_from_world_z;
    return fv3(fma(p.z, fv(z.x), fma(p.y, fv(y.x), p.x * fv(x.x))),
               fma(p.z, fv(z.y), fma(p.y, fv(y.y), p.x * fv(x.y))),
               fma(p.z, fv(z.z), fma(p.y, fv(y.z), p.x * fv(x.z))));
}

// Four texels and how far the pixel is from the first to the others.
typedef struct MapTexels {
    UV upper_left, upper_right, lower_left, lower_right;  // places
    FV right, down;                                       // 0..1
} MapTexels;

// `size`: width, height and first place of a level.
static inline MapTexels texels_towards(FV3 d, uint4 size) {
    FV width = fv((float)size.x);
    FV last_row = fv((float)(size.y - 1u));
    // The inverse of Environment::direction(): columns from behind over -X and ahead, rows from
    // above.
    FV turns = angle_of(d.x, -d.z) * (0.5f / PI) + 0.5f;
    FV from_top = angle_of(lane_sqrt(fma(d.x, d.x, d.z * d.z)), d.y) * (1.0f / PI);
    FV column = fma(turns, width, fv(-0.5f));
    FV row = min(max(fma(from_top, fv((float)size.y), fv(-0.5f)), fv(0.0f)), last_row);
    FV left = floor(column), top = floor(row);
    FV right = left + 1.0f;
    right = lane_select(right >= width, fv(0.0f), right);
    MapTexels t;
    t.right = column - left;
    t.down = row - top;
    left = lane_select(left < fv(0.0f), width - 1.0f, left);
    UV upper = lane_to_uint(top) * size.x + size.z;
    UV lower = lane_to_uint(min(top + 1.0f, last_row)) * size.x + size.z;
    t.upper_left = upper + lane_to_uint(left);
    t.upper_right = upper + lane_to_uint(right);
    t.lower_left = lower + lane_to_uint(left);
    t.lower_right = lower + lane_to_uint(right);
    return t;
}

// A channel of a texel of each lane.
static inline FV texel_channel(global const float* texels, UV place, uint channel) {
    UV at = place * 3u + channel;
#if VW == 1
    return texels[at];
#else
    uint index[VW];
    lane_store(at, index);
    return lane_gather(FV, texels, index);
#endif
}

static inline FV filtered(global const float* texels, MapTexels t, uint channel) {
    FV a = texel_channel(texels, t.upper_left, channel);
    FV c = texel_channel(texels, t.lower_left, channel);
    FV upper = fma(t.right, texel_channel(texels, t.upper_right, channel) - a, a);
    FV lower = fma(t.right, texel_channel(texels, t.lower_right, channel) - c, c);
    return fma(t.down, lower - upper, upper);
}

static inline FV3 filtered_rgb(global const float* texels, MapTexels t) {
    return fv3(filtered(texels, t, 0u), filtered(texels, t, 1u), filtered(texels, t, 2u));
}
#endif
