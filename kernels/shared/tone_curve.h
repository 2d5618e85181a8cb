// SPDX-License-Identifier: Apache-2.0
// Tone curves and the sRGB transfer function, for display only: files of linear light do not use
// them.
#ifndef KILOLUX_SHARED_TONE_CURVE_H
#define KILOLUX_SHARED_TONE_CURVE_H
#include "kernels/shared/power.h"
#include "kernels/shared/types.h"

#define TONE_CURVE_NONE 0
#define TONE_CURVE_NEUTRAL 1  // Khronos PBR Neutral
#define TONE_CURVE_ACES 2     // S. Hill's fit of the ACES RRT and sRGB ODT
#define TONE_CURVE_AGX 3      // T. Sobotka's AgX, base look, by B. Wrensch's fit

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

// log2(x) of a normal x > 0 within AgX's exposures, as a share of them. x = m 2^e with m in
// [sqrt(1/2), sqrt(2)).
SHARED_FN FV agx_exposure(FV x) {
    x = min(max(x, fv(1.7578e-4f)), fv(16.2917f));  // 2^-12.47393, 2^4.026069
    UV e = (lane_bits(x) - lane_uint(SQRT_HALF_BITS)) & lane_uint(EXPONENT_MASK);  // times 2^23
    FV f = fma(-x, lane_from_bits(lane_uint(ONE_BITS) - e), fv(1.0f));             // 1 - m
    FV stops = fma(-f, log2_slope(f), lane_from_int(e) * fv(1.1920929e-7f));
    return min(max((stops + fv(12.47393f)) * fv(1.0f / 16.499999f), fv(0.0f)), fv(1.0f));
}

SHARED_FN FV agx_contrast(FV x) {
    FV x2 = x * x;
    FV high = fma(fma(fv(15.5f), x, fv(-40.14f)), x, fv(31.96f)) * (x2 * x2);
    return high + fma(fma(fma(fv(-6.868f), x, fv(0.4298f)), x, fv(0.1191f)), x, fv(-0.00232f));
}

// The curve's values are for a display of gamma 2.2.
SHARED_FN FV agx_linear(FV v) {
    v = min(max(v, fv(0.0f)), fv(1.0f));
    return pow_of_cos2(v, fv(1.0f) - v, fv(1.0f), fv(2.2f));
}

// Benjamin Wrensch, "Minimal AgX Implementation" (iolite-engine.com, 2023): inset matrix, log2
// exposure, sixth-degree contrast, outset matrix.
SHARED_FN FV3 agx_tone_curve(FV3 c) {
    FV r = agx_contrast(agx_exposure(
        fma(fv(0.842479062f), c.x, fma(fv(0.0784336f), c.y, fv(0.0792237451f) * c.z))));
    FV g = agx_contrast(agx_exposure(
        fma(fv(0.0423282422f), c.x, fma(fv(0.878468636f), c.y, fv(0.0791661274f) * c.z))));
    FV b = agx_contrast(agx_exposure(
        fma(fv(0.0423756549f), c.x, fma(fv(0.0784336f), c.y, fv(0.879142973f) * c.z))));
    return fv3(
        agx_linear(fma(fv(1.196879f), r, fma(fv(-0.0980208811f), g, fv(-0.0990297441f) * b))),
        agx_linear(fma(fv(-0.0528968518f), r, fma(fv(1.15190313f), g, fv(-0.0989611768f) * b))),
        agx_linear(fma(fv(-0.0529716355f), r, fma(fv(-0.0980434501f), g, fv(1.15107367f) * b))));
}

// The curve by its number.
SHARED_FN FV3 tone_curve_of(int curve, FV3 c) {
    if (curve == TONE_CURVE_NEUTRAL) return neutral_tone_curve(c);
    if (curve == TONE_CURVE_ACES) return aces_tone_curve(c);
    if (curve == TONE_CURVE_AGX) return agx_tone_curve(c);
    return c;
}

// Whether light is that of a backdrop, but for the rounding of a mean of samples. NaN is not.
SHARED_FN MASK is_backdrop(FV3 c, FV3 backdrop) {
    FV3 d = fv3(c.x - backdrop.x, c.y - backdrop.y, c.z - backdrop.z);
    FV distance2 = fma(d.x, d.x, fma(d.y, d.y, d.z * d.z));
    FV length2 = fma(backdrop.x, backdrop.x, fma(backdrop.y, backdrop.y, backdrop.z * backdrop.z));
    return distance2 <= fv(1e-10f) * length2;
}

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
