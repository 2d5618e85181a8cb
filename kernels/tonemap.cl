// SPDX-License-Identifier: Apache-2.0
// Linear HDR radiance -> 8-bit sRGB: exposure, tone curve, transfer function, exact rounding.
// One work-item makes VW neighbouring pixels of a row.
#include "kernels/device/srgb.h"
#include "kernels/shared/tone_curve.h"

#ifndef TONE_CURVE
#define TONE_CURVE TONE_CURVE_NEUTRAL
#endif

// NaN and negative light are black, infinite light is white, not what a tone curve would make of
// them.
static inline FV displayable(FV v) { return min(lane_select(v > fv(0.0f), v, fv(0.0f)), fv(1e9f)); }

kernel void tonemap(
    global const float* restrict radiance,         // [3][height][stride]
    uint pixel_count,                              // height * stride
    float gain,                                    // 2^exposure
    global const float* restrict bucket_boundary,  // [SRGB_BUCKETS]
    global const uint* restrict bucket_code,       // [SRGB_BUCKETS]
    global uint* restrict display) {  // out [height][stride]: R | G << 8 | B << 16 | 255 << 24
    uint pixel = (uint)get_global_id(0) * VW;
    if (pixel >= pixel_count) return;
    FV3 c =
        fv3(lane_load(radiance + pixel) * gain, lane_load(radiance + pixel_count + pixel) * gain,
            lane_load(radiance + 2 * pixel_count + pixel) * gain);
    c = fv3(displayable(c.x), displayable(c.y), displayable(c.z));
    c = tone_curve_of(TONE_CURVE, c);
    UV r = srgb_code(bucket_boundary, bucket_code, c.x);
    UV g = srgb_code(bucket_boundary, bucket_code, c.y);
    UV b = srgb_code(bucket_boundary, bucket_code, c.z);
    lane_store(r | (g << 8) | (b << 16) | 0xff000000u, display + pixel);
}
