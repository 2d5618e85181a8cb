// SPDX-License-Identifier: Apache-2.0
// GGX lobes with Smith's height-correlated masking and shadowing, and Schlick's reflectance (glTF
// 2.0, appendix B).
//
// HAS_ANISOTROPY: lobes may be stretched along a tangent t (KHR_materials_anisotropy), b = n x t:
//   D(h) = 1 / (pi at ab X^2),  X = (h.t / at)^2 + (h.b / ab)^2 + (h.n)^2
//   V = 1 / 2 / (n.l S(v) + n.v S(l)),  S(d)^2 = (at d.t)^2 + (ab d.b)^2 + (d.n)^2
#ifndef KILOLUX_SHARED_LOBES_GGX_H
#define KILOLUX_SHARED_LOBES_GGX_H
#include "kernels/shared/types.h"

#ifndef HAS_ANISOTROPY
#define HAS_ANISOTROPY 0
#endif

// Perceptual roughness below which a lobe is too narrow for float32 and 2x16 normals (Filament's
// limit).
#define ROUGHNESS_MIN 0.045f
// Smallest cosine of the angle between normal and eye (Filament, MIN_N_DOT_V).
#define N_DOT_V_MIN 1e-4f

#if defined(__cplusplus)
namespace kilolux {
#endif

// A lobe as the eye sees it. Where it is stretched, `alpha` is sqrt(at ab), `alpha2` ab^2 and
// `slope` that along the tangent.
SHARED_PLAIN_STRUCT(GgxLobe) {
    FV n_dot_v;
    FV alpha;    // roughness^2
    FV alpha2;   // roughness^4
    FV slope;    // (1 - alpha2) / alpha
    FV smith_v;  // S(v) = sqrt(n.v^2 (1 - alpha2) + alpha2)
#if HAS_ANISOTROPY
    FV3 tangent;  // unit, perpendicular to the normal
    FV t_dot_v;
    FV stretch;  // at^2 - ab^2
    FV rise;     // of the slope across the tangent
#endif
};

// (1 - cosine)^5 of Schlick's f0 + (1 - f0) (1 - cosine)^5, from 1 - cosine.
SHARED_FN FV schlick_rise(FV complement) {
    FV dark = max(complement, fv(0.0f));
    FV dark2 = dark * dark;
    return dark2 * dark2 * dark;
}

SHARED_FN FV clamped_alpha(FV roughness) {
    FV r = max(roughness, fv(ROUGHNESS_MIN));
    return r * r;
}

// S(d)^2 of a round lobe, by the cosine of the unit direction d to the normal.
SHARED_FN FV smith_square(GgxLobe lobe, FV n_dot_d) {
    return fma(n_dot_d * n_dot_d, fv(1.0f) - lobe.alpha2, lobe.alpha2);
}

SHARED_FN GgxLobe make_ggx_lobe(FV3 normal, FV3 to_eye, FV roughness) {
    GgxLobe lobe;
    lobe.alpha = clamped_alpha(roughness);
    lobe.alpha2 = lobe.alpha * lobe.alpha;
    lobe.slope = (fv(1.0f) - lobe.alpha2) / lobe.alpha;
    lobe.n_dot_v = max(dot3(normal, to_eye), fv(N_DOT_V_MIN));
    lobe.smith_v = lane_sqrt(fma(lobe.n_dot_v * lobe.n_dot_v, fv(1.0f) - lobe.alpha2, lobe.alpha2));
#if HAS_ANISOTROPY
    lobe.tangent = fv3(fv(0.0f), fv(0.0f), fv(0.0f));
    lobe.t_dot_v = lobe.stretch = lobe.rise = fv(0.0f);
#endif
    return lobe;
}

#if HAS_ANISOTROPY
// S(d), by the cosines of the unit direction d to the normal and the tangent.
SHARED_FN FV stretched_smith(GgxLobe lobe, FV n_dot_d, FV t_dot_d) {
    return lane_sqrt(fma(t_dot_d * t_dot_d, lobe.stretch, smith_square(lobe, n_dot_d)));
}

// The lobe with `strength` along the tangent. What it adds to a round lobe's terms is exactly 0
// without strength, and positive else: nothing cancels in narrow lobes.
SHARED_FN GgxLobe stretched_lobe(GgxLobe lobe, FV3 to_eye, FV3 tangent, FV strength) {
    FV across = lobe.alpha, one = fv(1.0f);
    FV along = fma(one - across, strength * strength, across);
    FV ratio = lane_select(strength > fv(0.0f), lane_sqrt(across / along), one);
    lobe.tangent = tangent;
    lobe.t_dot_v = dot3(tangent, to_eye);
    lobe.stretch = (along - across) * (along + across);
    lobe.rise = lobe.stretch * ratio / (along * lobe.alpha2);
    lobe.alpha = along * ratio;
    lobe.slope = (one - along * along) / along * ratio;
    lobe.smith_v = stretched_smith(lobe, lobe.n_dot_v, lobe.t_dot_v);
    return lobe;
}
#endif

// The half vector h, not normalised, about a normal n.
SHARED_PLAIN_STRUCT(HalfVector) {
    FV3 h;
    FV hh;    // its length squared
    FV h4;    // that squared
    FV3 nxh;  // n x h
    FV sin2;  // |n x h|^2
};

SHARED_FN HalfVector about_normal(HalfVector half_way, FV3 normal) {
    half_way.nxh = cross3(normal, half_way.h);
    half_way.sin2 = dot3(half_way.nxh, half_way.nxh);
    return half_way;
}

// Of light from the unit direction `v` * `inv_length`.
SHARED_FN HalfVector half_vector(FV3 normal, FV3 to_eye, FV3 v, FV inv_length) {
    HalfVector half_way;
    FV3 h = fv3(fma(v.x, inv_length, to_eye.x), fma(v.y, inv_length, to_eye.y),
                fma(v.z, inv_length, to_eye.z));
    half_way.h = h;
    // 1e-12: light from straight behind the view has no half vector; the sum is only rounding (1e-7
    // long).
    half_way.hh = max(dot3(h, h), fv(1e-12f));
    half_way.h4 = half_way.hh * half_way.hh;
    half_way.nxh = h;  // functions take the struct whole
    half_way.sin2 = half_way.hh;
    return about_normal(half_way, normal);
}

// `lit` * D * V without its constant 1 / (2 pi), which reflected_radiance() multiplies in; `ggx`:
// 1 / sqrt(D); smith_l: S(l).
SHARED_FN FV ggx_quotient(GgxLobe lobe, FV ggx, FV smith_l, FV n_dot_l, FV lit_h4) {
    FV smith = fma(n_dot_l, lobe.smith_v, lobe.n_dot_v * smith_l);
    return lane_divide(lit_h4, ggx * ggx * smith);
}

// 1 / sqrt(D) of a round lobe. Lagrange's identity |n x h|^2 = h^2 - (n.h)^2 keeps narrow lobes
// (Filament, 4.4.1). Both sides of D's fraction are multiplied by h^2, which saves normalising h,
// and divided by alpha, so that the peak of a mirror keeps the size it has in the end.
SHARED_FN FV round_ggx(GgxLobe lobe, HalfVector half_way) {
    return fma(half_way.sin2, lobe.slope, lobe.alpha * half_way.hh);
}

// The light of a round lobe.
SHARED_FN FV ggx_light(GgxLobe lobe, HalfVector half_way, FV n_dot_l, FV lit) {
    FV smith_l = lane_sqrt(smith_square(lobe, n_dot_l));
    return ggx_quotient(lobe, round_ggx(lobe, half_way), smith_l, n_dot_l, lit * half_way.h4);
}

#if HAS_ANISOTROPY
// The light of a lobe that may be stretched.
SHARED_FN FV stretched_light(GgxLobe lobe, HalfVector half_way, FV n_dot_l, FV lit) {
    FV b_dot_h = dot3(lobe.tangent, half_way.nxh);  // up to its sign
    FV ggx = fma(b_dot_h * b_dot_h, lobe.rise, round_ggx(lobe, half_way));
    FV t_dot_l = dot3(lobe.tangent, half_way.h) - lobe.t_dot_v;
    FV smith_l = stretched_smith(lobe, n_dot_l, t_dot_l);
    return ggx_quotient(lobe, ggx, smith_l, n_dot_l, lit * half_way.h4);
}
#endif

// D V n.l without 1 / (2 pi), at most, where n.h is at most `cosine`: V n.l <= 1 / (2 smith_v).
SHARED_FN FV ggx_bound(GgxLobe lobe, FV cosine) {
    FV ggx = fma(fv(1.0f) - cosine * cosine, lobe.slope, lobe.alpha);
    return fv(1.0f) / (ggx * ggx * lobe.smith_v);
}

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
