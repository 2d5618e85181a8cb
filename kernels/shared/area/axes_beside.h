// SPDX-License-Identifier: Apache-2.0
// Two axes across a third one.
#ifndef KILOLUX_SHARED_AREA_AXES_BESIDE_H
#define KILOLUX_SHARED_AREA_AXES_BESIDE_H
#include "kernels/shared/types.h"

#if defined(__cplusplus)
namespace kilolux {
#endif

// Two unit vectors that are perpendicular to a unit vector and to each other.
SHARED_PLAIN_STRUCT(AxesBeside) { FV3 x, y; };

// Duff et al. 2017, "Building an Orthonormal Basis, Revisited". side: -1 where n.z is negative,
// else 1; a: -1 / (side + n.z).
SHARED_FN AxesBeside axes_beside(FV3 n, FV side, FV a) {
    FV b = n.x * n.y * a;
    AxesBeside axes;
    axes.x = fv3(fma(side * n.x, n.x * a, fv(1.0f)), side * b, -side * n.x);
    axes.y = fv3(b, fma(n.y, n.y * a, side), -n.y);
    return axes;
}

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
