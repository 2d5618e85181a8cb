// SPDX-License-Identifier: Apache-2.0
// Linear light to 8-bit sRGB codes, correctly rounded.
#ifndef KILOLUX_DEVICE_SRGB_H
#define KILOLUX_DEVICE_SRGB_H
#include "kernels/device/lanes.h"

// BUCKET_ARGS.
typedef struct SrgbTable {
    global const float* boundary;
    global const uint* code;
} SrgbTable;
#define SRGB_TABLE_OF_ARGS ((SrgbTable){bucket_boundary, bucket_code})

typedef struct SrgbBucket {
    FV boundary;
    UV code;
} SrgbBucket;

static inline SrgbBucket bucket_at(SrgbTable table, UV bucket) {
#if VW == 1
    return (SrgbBucket){table.boundary[bucket], table.code[bucket]};
#else
    uint index[VW];
    lane_store(bucket, index);
    return (SrgbBucket){lane_gather(FV, table.boundary, index), lane_gather(UV, table.code, index)};
#endif
}

#include "kernels/shared/srgb_code.h"

// The code by arithmetic in all lanes at once: 255 (1.055 c^(1/2.4) - 0.055) + 0.5 as a polynomial
// in c^(1/4), minimax on [0.0031, 1], error 3.7e-4. The lanes use the table only where a value lies
// within 1/1024 of a code's boundary, which is more than that error and float's rounding (1e-4).
static inline UV srgb_code(SrgbTable table, FV v) {
    FV c = min(max(v, fv(bits_float(SRGB_FIRST_BITS))), fv(1.0f));
    FV u = lane_sqrt(lane_sqrt(c));
    FV curve = fma(u, fv(17.4495867f), fv(-81.4141021f));
    curve = fma(u, curve, fv(167.921942f));
    curve = fma(u, curve, fv(-217.775036f));
    curve = fma(u, curve, fv(348.426791f));
    curve = fma(u, curve, fv(35.5733148f));
    curve = fma(u, curve, fv(0.5f - 0.055f * 255.0f - 1.1571349f));
    FV line = fma(c, fv(12.92f * 255.0f), fv(0.5f));
    FV code_and_rest = lane_select(c <= fv(0.0031308f), line, curve);
    IV code = lane_to_int(code_and_rest);
    FV from_middle = (code_and_rest - lane_to_float(code)) - fv(0.5f);
    if (lane_any(max(from_middle, -from_middle) > fv(0.5f - 1.0f / 1024.0f))) {
        return srgb_code_by_table(table, v);
    }
    return lane_bits(code);
}
#endif
