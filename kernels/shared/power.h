// SPDX-License-Identifier: Apache-2.0
// Powers on lanes. Written out rather than pow(): that is 10 times slower in vectors, and devices
// differ in it. 2^x: the polynomial of Cephes exp2f (Moshier 1989).
#ifndef KILOLUX_SHARED_POWER_H
#define KILOLUX_SHARED_POWER_H
#include "kernels/shared/types.h"
#if defined(__cplusplus)
namespace kilolux {
#endif

// c^n for c in [1e-30, 1], n >= 0; `c_less_1` is c - 1 as exactly as the caller knows it, which
// counts where a large n magnifies it. Absolute error below 2e-7 at any n.
SHARED_FN FV pow_of_unit(FV c, FV c_less_1, FV n) {
    // c = m 2^e with m in [sqrt(1/2), sqrt(2)): the constant is the bits of 1 less those of
    // sqrt(1/2).
    LANE_UINT biased = (lane_bits(c) + 0x4afb0du) >> 23u;
    FV e = lane_float_of(biased) - fv(127.0f);
    FV m = lane_float(lane_bits(c) - ((biased - 127u) << 23u));
    FV f = select_fv(e == fv(0.0f), c_less_1, m - fv(1.0f));
    // log2(1 + f) = 2 / ln 2 * atanh(t), |t| < 0.172; minimax, relative error 8e-10.
    FV t = f / (fv(2.0f) + f);
    FV t2 = t * t;
    FV slope = fma(t2, fma(t2, fma(t2, fv(0.430996776f), fv(0.576752663f)), fv(0.96179831f)),
                   fv(2.88539008f));
    FV x = n * fma(t, slope, e);
    // 2^-60 is nothing beside the lobe's peak, and keeps denormals, which are slow, out of what
    // follows.
    x = max(x, fv(-60.0f));
    LANE_UINT i = lane_uint_of(x - fv(0.5f));  // to nearest, as x <= 0 and conversion truncates
    FV g = x - lane_float_of(i);
    FV q = fv(1.535336188e-4f);
    q = fma(q, g, fv(1.339887440e-3f));
    q = fma(q, g, fv(9.618437358e-3f));
    q = fma(q, g, fv(5.550332471e-2f));
    q = fma(q, g, fv(2.402264791e-1f));
    q = fma(q, g, fv(6.931472029e-1f));
    q = fma(q, g, fv(1.0f));
    return q * lane_float((i + 127u) << 23u);
}

// (1 - h)^n for h in [0, 1], n >= 0: 1 - h itself would round h away.
SHARED_FN FV pow_one_minus(FV h, FV n) { return pow_of_unit(max(fv(1.0f) - h, fv(1e-30f)), -h, n); }

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
