// SPDX-License-Identifier: Apache-2.0
// Linear light to 8-bit sRGB codes by table, for OpenCL C and GLSL.
//
// Each language defines before (kernels/device/srgb.h, raster/shaders/planes.frag):
//   SrgbTable                 the buckets of host/base/formats/srgb.h
//   bucket_at(table, bucket)  SrgbBucket: the code at its lower end, and the next code's first
//   float
#ifndef KILOLUX_SHARED_SRGB_CODE_H
#define KILOLUX_SHARED_SRGB_CODE_H
#include "kernels/shared/tone_curve.h"

// The sRGB code of linear v, correctly rounded: IEC 61966-2-1.
SHARED_FN UV srgb_code_by_table(SrgbTable table, FV v) {
    // Below 2^-13 is code 0.
    FV c = min(max(v, fv(bits_float(SRGB_FIRST_BITS))), fv(1.0f));
    UV bucket = (lane_bits(c) - SRGB_FIRST_BITS) >> SRGB_BUCKET_SHIFT;
    SrgbBucket at = bucket_at(table, bucket);
    return at.code + lane_select_uint(c >= at.boundary, lane_uint(1u), lane_uint(0u));
}
#endif
