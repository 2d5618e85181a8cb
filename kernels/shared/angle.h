// SPDX-License-Identifier: Apache-2.0
// Angles by sums, products and divisions: the same bits for every lane width.
#ifndef KILOLUX_SHARED_ANGLE_H
#define KILOLUX_SHARED_ANGLE_H
#include "kernels/shared/types.h"

#if defined(__cplusplus)
namespace kilolux {
#endif

// The angle of (x, y) from +X towards +Y, from 0 to pi for y >= 0 [rad]. Sums, products and one
// division: the same bits for every width. Within 4e-7 of the angle; 0 for (0, 0).
SHARED_FN FV half_turn_angle(FV x, FV y) {
    FV along = max(x, -x);
    FV most = max(max(along, y), fv(1e-37f));
    FV t = min(along, y) / most;
    FV s = t * t;
    // atan(t) / t on [0, 1] within 1e-7: interpolated at the nodes of Chebyshev's polynomial in
    // t^2.
    FV p = fma(s, fv(0.00276628346f), fv(-0.015731249f));
    p = fma(s, p, fv(0.0421376228f));
    p = fma(s, p, fv(-0.0745685473f));
    p = fma(s, p, fv(0.106183708f));
    p = fma(s, p, fv(-0.141977981f));
    p = fma(s, p, fv(0.199918717f));
    p = fma(s, p, fv(-0.333330363f));
    FV angle = fma(s, p, fv(1.0f)) * t;
    angle = lane_select(y > along, fv(1.570796327f) - angle, angle);
    return lane_select(x < fv(0.0f), fv(3.141592654f) - angle, angle);
}

// Sine and cosine of an angle.
SHARED_PLAIN_STRUCT(SineCosine) { FV sine, cosine; };

// Of `angle` from -pi to pi [rad], within 7e-7; the sine of angles up to 3 also within 2e-6 of
// itself.
SHARED_FN SineCosine sine_cosine(FV angle) {
    // Taylor's polynomials of half the angle, at most pi / 2: the first terms left out are 4e-9 and
    // 5e-8 of 1.
    FV h = angle * fv(0.5f);
    FV q = h * h;
    FV s = fma(q, fv(-2.50521084e-8f), fv(2.75573192e-6f));
    s = fma(q, s, fv(-1.98412698e-4f));
    s = fma(q, s, fv(8.33333333e-3f));
    s = fma(q, s, fv(-1.66666667e-1f));
    s = fma(q * s, h, h);
    FV c = fma(q, fv(2.08767570e-9f), fv(-2.75573192e-7f));
    c = fma(q, c, fv(2.48015873e-5f));
    c = fma(q, c, fv(-1.38888889e-3f));
    c = fma(q, c, fv(4.16666667e-2f));
    c = fma(q, c, fv(-0.5f));
    c = fma(q, c, fv(1.0f));
    SineCosine turn;
    turn.sine = fv(2.0f) * s * c;
    turn.cosine = fma(fv(-2.0f) * s, s, fv(1.0f));
    return turn;
}

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
