// SPDX-License-Identifier: Apache-2.0
// Vectors as sums of two floats: exact differences, and cross products whose small results are as
// accurate as large ones.
#ifndef KILOLUX_DEVICE_TWOFOLD_H
#define KILOLUX_DEVICE_TWOFOLD_H
#include "kernels/device/lanes.h"

typedef struct TwofoldVec3 {
    FV3 high, low;  // |low| <= 2^-24 |high|
} TwofoldVec3;

// The rounding error of `difference` = a - b (two_sum: Knuth, TAOCP vol. 2, 4.2.2).
static inline FV difference_error(FV a, FV b, FV difference) {
    FV b_part = difference - a;
    return (a - (difference - b_part)) - (b + b_part);
}

// a - b, exact.
static inline TwofoldVec3 twofold_difference(FV3 a, FV3 b) {
    TwofoldVec3 out;
    out.high = sub3(a, b);
    out.low = fv3(difference_error(a.x, b.x, out.high.x), difference_error(a.y, b.y, out.high.y),
                  difference_error(a.z, b.z, out.high.z));
    return out;
}

// a d - b c within 1.5 units in its last place (Kahan; Jeannerod et al., Math. Comp. 82, 2013).
static inline FV difference_of_products(FV a, FV d, FV b, FV c) {
    FV product = b * c;
    FV error = fma(-b, c, product);
    return fma(a, d, -product) + error;
}

static inline FV3 cross_of_floats(FV3 a, FV3 b) {
    return fv3(difference_of_products(a.y, b.z, a.z, b.y),
               difference_of_products(a.z, b.x, a.x, b.z),
               difference_of_products(a.x, b.y, a.y, b.x));
}

// a x b within 2^-22 of its length and 2^-44 of the products that it sums.
static inline FV3 twofold_cross(TwofoldVec3 a, TwofoldVec3 b) {
    FV3 rest = add3(cross3(a.high, b.low), cross3(a.low, b.high));
    return add3(cross_of_floats(a.high, b.high), rest);
}
#endif
