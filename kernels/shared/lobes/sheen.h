// SPDX-License-Identifier: Apache-2.0
// The lobe of KHR_materials_sheen: the "Charlie" distribution with its own visibility, and the
// share of light that it returns (Conty and Kulla 2017, "Production Friendly Microfacet Sheen
// BRDF").
#ifndef KILOLUX_SHARED_LOBES_SHEEN_H
#define KILOLUX_SHARED_LOBES_SHEEN_H
#include "kernels/shared/lobes/ggx.h"
#include "kernels/shared/power.h"
#include "kernels/shared/types.h"

// The extension's l(x) = a / (1 + b x^c) + d x + e: ROW(name, at_1, at_0) has
// the values at alpha 1 and 0, mixed by (1 - alpha)^2.
#define SHEEN_SHADOW_ROWS(ROW)   \
    ROW(a, 21.5473f, 25.3245f)   \
    ROW(b, 3.82987f, 3.32435f)   \
    ROW(c, 0.19823f, 0.16801f)   \
    ROW(d, -1.97760f, -1.27393f) \
    ROW(e, -4.32054f, -4.85967f)

// log2 of the share E of light that a white sheen returns, at most 0, as a polynomial of the cosine
// x: ROW(name, ...) has the factor of its power by 1, r, r^2, r^3, 1 / r and 1 / r^2 of the
// roughness r. A fit to integrals of the lobe, limited to 1, which the model exceeds at grazing
// angles below r = 0.25; its error is at most 0.013 where x > 0.009, and 0.2 below
// (tests/measure/lobes/sheen_test.cpp).
#define SHEEN_ALBEDO_ROWS(ROW)                                                          \
    ROW(albedo_0, 0.716415693f, -6.60801308f, 11.0991052f, -5.37777634f, 0.112214301f,  \
        -0.00161116947f)                                                                \
    ROW(albedo_1, -5.91632225f, 16.3136024f, -22.5430656f, 9.66496366f, -1.90899628f,   \
        0.00418380374f)                                                                 \
    ROW(albedo_2, -10.6857288f, 19.2356276f, -11.1710539f, 2.12386925f, 4.96534466f,    \
        -0.0728007349f)                                                                 \
    ROW(albedo_3, -0.653658605f, -5.92654641f, 7.71845285f, -3.13893475f, 0.228378513f, \
        -0.867033241f)
// |dE / dx| is at most this + SHEEN_SLOPE_BY_R / r.
#define SHEEN_SLOPE 3.0f
#define SHEEN_SLOPE_BY_R 1.3f

#if defined(__cplusplus)
namespace kilolux {
#endif

// The lobe of white sheen as the eye sees it.
SHARED_PLAIN_STRUCT(SheenLobe) {
    FV a, b, c, d, e;                           // of l(x)
    FV twice_half;                              // 2 l(0.5)
    FV exponent;                                // of sin^2 of n and h: 1 / (2 alpha)
    FV scale;                                   // (2 + 1 / alpha) / (4 n.v)
    FV shadow;                                  // 1 + lambda(n.v)
    FV albedo_0, albedo_1, albedo_2, albedo_3;  // log2 of E by powers of the cosine
    FV albedo;                                  // E(n.v)
    FV slope;                                   // of E, at most
};

SHARED_FN FV sheen_l(SheenLobe lobe, FV x) {
    FV power = pow_of_cos2(x, fv(1.0f) - x, fv(1.0f), lobe.c);
    return fma(lobe.d, x, lobe.a / fma(lobe.b, power, fv(1.0f)) + lobe.e);
}

// The extension's lambdaSheen() at a cosine from 0 to 1.
SHARED_FN FV sheen_lambda(SheenLobe lobe, FV cosine) {
    MASK grazing = cosine < fv(0.5f);
    FV l = sheen_l(lobe, lane_select(grazing, cosine, max(fv(1.0f) - cosine, fv(0.0f))));
    l = lane_select(grazing, l, lobe.twice_half - l);
    // e^l is at most 2^30 (a + e = 20.5).
    return exp2_of_negative(fma(l, fv(1.44269504f), fv(-30.0f))) * fv(1073741824.0f);
}

SHARED_FN FV sheen_albedo(SheenLobe lobe, FV cosine) {
    FV high = fma(fma(lobe.albedo_3, cosine, lobe.albedo_2), cosine, lobe.albedo_1);
    return exp2_of_negative(min(fma(high, cosine, lobe.albedo_0), fv(0.0f)));
}

SHARED_FN SheenLobe make_sheen_lobe(FV n_dot_v, FV roughness) {
    SheenLobe lobe;
    FV r = max(roughness, fv(ROUGHNESS_MIN));
    FV alpha = r * r, inverse = fv(1.0f) / r;
    FV share = (fv(1.0f) - alpha) * (fv(1.0f) - alpha);
#define MIX_SHADOW(name, at_1, at_0) lobe.name = fma(share, fv((at_0) - (at_1)), fv(at_1));
    SHEEN_SHADOW_ROWS(MIX_SHADOW)
#define MIX_ALBEDO(name, one, of_r, of_r2, of_r3, of_inverse, of_inverse2) \
    lobe.name = fma(fma(fma(fv(of_r3), r, fv(of_r2)), r, fv(of_r)), r,     \
                    fma(fma(fv(of_inverse2), inverse, fv(of_inverse)), inverse, fv(one)));
    SHEEN_ALBEDO_ROWS(MIX_ALBEDO)
    // Functions take the lobe whole.
    lobe.twice_half = lobe.exponent = lobe.scale = fv(0.0f);
    lobe.shadow = lobe.albedo = lobe.slope = fv(0.0f);
    lobe.twice_half = fv(2.0f) * sheen_l(lobe, fv(0.5f));
    lobe.exponent = fv(0.5f) / alpha;
    lobe.scale = fv(0.25f) * (fv(2.0f) + fv(1.0f) / alpha) / n_dot_v;
    lobe.shadow = fv(1.0f) + sheen_lambda(lobe, min(n_dot_v, fv(1.0f)));
    lobe.albedo = sheen_albedo(lobe, n_dot_v);
    lobe.slope = fma(fv(SHEEN_SLOPE_BY_R), inverse, fv(SHEEN_SLOPE));
    return lobe;
}

// D V n.l without 1 / (2 pi) and `scale`, of the squares of |n x h|, n.h and h.
SHARED_FN FV sheen_light(SheenLobe lobe, FV sin2, FV cos2, FV scale, FV n_dot_l) {
    FV charlie = pow_of_cos2(sin2, cos2, scale, lobe.exponent);
    FV light = lane_divide(charlie, lobe.shadow + sheen_lambda(lobe, n_dot_l));
    return lane_select(n_dot_l > fv(0.0f), light, fv(0.0f));
}

// The most that sheen_light() can be: n.h = (n.v + n.l) / |h| is at least n.v / 2.
SHARED_FN FV sheen_bound(SheenLobe lobe, FV n_dot_v) {
    FV least = min(fv(0.25f) * n_dot_v * n_dot_v, fv(1.0f));
    return pow_of_cos2(fv(1.0f) - least, least, fv(1.0f), lobe.exponent) / lobe.shadow;
}

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
