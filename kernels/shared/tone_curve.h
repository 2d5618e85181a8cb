// SPDX-License-Identifier: Apache-2.0
// Display: tone curves and the sRGB transfer function. Display only; files of linear light never
// see it.
#ifndef KILOLUX_SHARED_TONE_CURVE_H
#define KILOLUX_SHARED_TONE_CURVE_H
#include "kernels/shared/types.h"

#define TONE_CURVE_NONE 0
#define TONE_CURVE_NEUTRAL 1  // Khronos PBR Neutral
#define TONE_CURVE_ACES 2     // S. Hill's fit of the ACES RRT and sRGB ODT

// Linear light by equal steps of the float's bits, 128 an octave from 2^-13 to 1: so fine that a
// bucket holds at most one boundary between two 8-bit sRGB codes. Below 2^-13 the code is 0.
#define SRGB_BUCKET_SHIFT 16
#define SRGB_FIRST_BITS 0x39000000u
#define SRGB_BUCKETS 1665

#if defined(__cplusplus)
namespace kilolux {
#endif

// Khronos PBR Neutral Tone Mapper specification, 2024: 1:1 below 0.8 - 0.04, then compressed.
SHARED_FN FV3 neutral_tone_curve(FV3 c) {
    FV lowest = min(c.x, min(c.y, c.z));
    FV offset =
        lane_select(lowest < fv(0.08f), fma(fv(-6.25f) * lowest, lowest, lowest), fv(0.04f));
    c = fv3(c.x - offset, c.y - offset, c.z - offset);
    FV peak = max(c.x, max(c.y, c.z));
    FV start = fv(0.76f);
    FV d = fv(0.24f);
    FV new_peak = fv(1.0f) - d * d / (max(peak, start) + d - start);
    FV3 squeezed = scale3(c, new_peak / max(peak, start));
    FV g = fv(1.0f) - fv(1.0f) / fma(fv(0.15f), peak - new_peak, fv(1.0f));
    MASK high = peak >= start;
    return fv3(lane_select(high, fma(g, new_peak - squeezed.x, squeezed.x), c.x),
               lane_select(high, fma(g, new_peak - squeezed.y, squeezed.y), c.y),
               lane_select(high, fma(g, new_peak - squeezed.z, squeezed.z), c.z));
}

SHARED_FN FV aces_rational(FV v) {
    return (v * (v + fv(0.0245786f)) - fv(0.000090537f)) /
           (v * fma(fv(0.983729f), v, fv(0.4329510f)) + fv(0.238081f));
}

// Stephen Hill, "ACES Fitted" (BakingLab, 2016): input matrix, rational fit, output matrix.
SHARED_FN FV3 aces_tone_curve(FV3 c) {
    FV r = aces_rational(fma(fv(0.59719f), c.x, fma(fv(0.35458f), c.y, fv(0.04823f) * c.z)));
    FV g = aces_rational(fma(fv(0.07600f), c.x, fma(fv(0.90834f), c.y, fv(0.01566f) * c.z)));
    FV b = aces_rational(fma(fv(0.02840f), c.x, fma(fv(0.13383f), c.y, fv(0.83777f) * c.z)));
    return fv3(fma(fv(1.60475f), r, fma(fv(-0.53108f), g, fv(-0.07367f) * b)),
               fma(fv(-0.10208f), r, fma(fv(1.10813f), g, fv(-0.00605f) * b)),
               fma(fv(-0.00327f), r, fma(fv(-0.07276f), g, fv(1.07602f) * b)));
}

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
