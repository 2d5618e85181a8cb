// SPDX-License-Identifier: Apache-2.0
// Polynomials of transformed cosines that are near to GGX lobes without reflectance, D V n.l of
// lobes/ggx.h, and of their albedos (Heitz, Dupuy, Hill and Neubelt 2016, "Real-Time
// Polygonal-Light Shading with Linearly Transformed Cosines"). The program
// tests/measure/area/fit/fit_ggx.cpp prints the tables;
// tests/measure/area/ggx_area_test.cpp checks their errors.
//
// Frame: +z the normal, the eye in the plane of x and z at x >= 0. The inverse of the transform is
//   [[along, 0, tilt], [0, across, 0], [0, 0, 1]]:
// it keeps the horizon, so that light from below is exactly 0, as in D V n.l. In narrow lobes it is
//   along = n.v^2 / (2 alpha), tilt = sin(v) n.v / (2 alpha), across = 1 / (2 alpha);
// elsewhere n.v becomes the spread k = sqrt(n.v^2 + GGX_SPREAD2 alpha^2), and each entry has a
// factor 1 + (1 - x^2) p(x, t), x = n.v / k. So have the albedo, and the cosine v.h whose Schlick
// term is the mean over the lobe, relative to k.
#ifndef KILOLUX_SHARED_AREA_GGX_FIT_H
#define KILOLUX_SHARED_AREA_GGX_FIT_H
#include "kernels/shared/types.h"

// Where n.v is small against alpha, along is about GGX_SPREAD2 alpha / 2.
#define GGX_SPREAD2 8.0f

// p as rows of powers of x, the highest first: POWER(...) has its factors by 1, t, t^2, t^3.
// t: roughness; of the albedo: alpha.
#define GGX_FIT_ALONG(POWER)                                      \
    POWER(1.26573881f, -16.9705356f, 25.2940287f, -8.16603112f)   \
    POWER(-0.644548004f, 20.807654f, -44.327281f, 21.5806773f)    \
    POWER(-0.596491775f, -4.32536761f, 12.5915223f, -7.14514072f) \
    POWER(-0.126123526f, 0.692385463f, -3.38124959f, 1.97019115f)
#define GGX_FIT_TILT(POWER)                                        \
    POWER(1.35798374f, -12.8380427f, 18.6757799f, -7.72028976f)    \
    POWER(-1.03604185f, 13.8497077f, -28.4060506f, 14.2908802f)    \
    POWER(-0.0680162196f, -1.57582784f, 6.32608375f, -4.62611506f) \
    POWER(-0.0794330842f, 0.284849287f, -2.69538058f, 1.48877785f)
#define GGX_FIT_ACROSS(POWER)                                     \
    POWER(0.777180607f, 1.53932829f, -11.1699282f, 18.7929723f)   \
    POWER(-0.963932136f, -3.38812955f, 13.5183131f, -18.9367299f) \
    POWER(-0.255862829f, 4.99958928f, -11.7801894f, 10.9910971f)  \
    POWER(0.495236771f, -2.14836211f, 2.95478125f, -1.06700819f)
#define GGX_FIT_ALBEDO(POWER)                                     \
    POWER(0.312063835f, -11.2717194f, 28.210359f, 49.5529131f)    \
    POWER(-0.815240915f, 18.6845407f, -68.3793162f, -23.3279538f) \
    POWER(1.0500238f, -9.01955352f, 39.9491434f, -2.66735758f)    \
    POWER(-0.605904774f, 1.7363639f, -10.9676319f, 3.55959386f)   \
    POWER(-0.0226142701f, 0.0101172201f, -0.00661820187f, -0.017887702f)
#define GGX_FIT_HALF(POWER)                                          \
    POWER(0.644860664f, -9.92272911f, 14.6090996f, -2.69621126f)     \
    POWER(0.00666628132f, 7.15973636f, -17.1397656f, 7.96178939f)    \
    POWER(-0.707878072f, 2.21430785f, -0.959879792f, -0.0861313871f) \
    POWER(0.24068001f, -2.76904691f, 2.61946157f, -0.930644035f)

#if defined(__cplusplus)
namespace kilolux {
#endif

#define ADD_FIT_POWER(one, of_t, of_t2, of_t3) \
    sum = fma(sum, x, fma(fma(fma(fv(of_t3), t, fv(of_t2)), t, fv(of_t)), t, fv(one)));
// p(x, t) of a table.
#define FIT_FUNCTION(name, powers)  \
    SHARED_FN FV name(FV x, FV t) { \
        FV sum = fv(0.0f);          \
        powers(ADD_FIT_POWER);      \
        return sum;                 \
    }
FIT_FUNCTION(fit_along, GGX_FIT_ALONG)
FIT_FUNCTION(fit_tilt, GGX_FIT_TILT)
FIT_FUNCTION(fit_across, GGX_FIT_ACROSS)
FIT_FUNCTION(fit_albedo, GGX_FIT_ALBEDO)
FIT_FUNCTION(fit_half, GGX_FIT_HALF)

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
