// SPDX-License-Identifier: Apache-2.0
// Powers on lanes. Written out instead of pow(), which is 10 times slower in vectors and differs
// between devices. Polynomials are minimax fits (Remez), evaluated in pairs (Estrin), since latency
// costs more here than arithmetic.
#ifndef KILOLUX_SHARED_POWER_H
#define KILOLUX_SHARED_POWER_H
#include "kernels/shared/types.h"
#if defined(__cplusplus)
namespace kilolux {
#endif

#define ONE_BITS 0x3f800000u
#define SQRT_HALF_BITS 0x3f3504f3u
#define EXPONENT_MASK 0xff800000u

// -log2(1 - f) / f for f in [1 - sqrt(2), 1 - sqrt(1/2)], relative error 1.7e-7.
SHARED_FN FV log2_slope(FV f) {
    FV f2 = f * f;
    FV low = fma(fma(f, fv(0.360239634f), fv(0.480923243f)), f2,
                 fma(f, fv(0.721352788f), fv(1.44269496f)));
    FV high = fma(fma(f, fv(0.1458116f), fv(0.234042506f)), f2,
                  fma(f, fv(0.248876936f), fv(0.287098686f)));
    return fma(high, f2 * f2, low);
}

// 2^x for x <= 0, relative error 9.2e-8 and exactly 1 at 0. Below -60 it is 2^-60: negligible
// beside a lobe's peak, and without denormals, which are slow.
SHARED_FN FV exp2_of_negative(FV x) {
    x = max(x, fv(-60.0f));
    UV i = lane_truncate(x - fv(0.5f));  // to nearest, as conversion truncates
    FV g = x - lane_from_int(i);
    FV g2 = g * g;
    FV q = fma(fma(fma(g, fv(1.32647546e-3f), fv(9.67149799e-3f)), g2,
                   fma(g, fv(5.55073346e-2f), fv(0.240222424f))),
               g2, fma(g, fv(0.693146978f), fv(1.0f)));
    return lane_from_bits(lane_bits(q) + (i << 23u));
}

// log2 of a positive number that is not denormal, error 1.7e-7 of it, or of 1 where it is larger.
SHARED_FN FV log2_of(FV x) {
    UV e = (lane_bits(x) - SQRT_HALF_BITS) & EXPONENT_MASK;  // times 2^23
    FV f = fma(-x, lane_from_bits(ONE_BITS - e), fv(1.0f));  // 1 - m of x = m 2^e
    return fma(-f, log2_slope(f), lane_from_int(e) * fv(1.1920929e-7f));
}

// cos^(2n) for an angle in [0, pi/2], with cos^2 = cos2 / scale, sin^2 = sin2 / scale and n >= 0.
// Near the peak, where a large n magnifies the rounding of cos^2, it uses sin^2, else cos^2.
// Absolute error below 3e-7 at any n.
SHARED_FN FV pow_of_cos2(FV cos2, FV sin2, FV scale, FV n) {
    MASK near = sin2 * fv(3.41421356f) < scale;  // cos^2 > sqrt(1/2)
    FV q = lane_select(near, sin2, cos2) / scale;
    FV c = lane_select(near, fv(1.0f), q);
    // c = m 2^e with m in [sqrt(1/2), sqrt(2)).
    UV e = (lane_bits(c) - SQRT_HALF_BITS) & EXPONENT_MASK;                        // times 2^23
    FV f = lane_select(near, q, fma(-c, lane_from_bits(ONE_BITS - e), fv(1.0f)));  // 1 - m
    return exp2_of_negative(n * fma(-f, log2_slope(f), lane_from_int(e) * fv(1.1920929e-7f)));
}

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
