// SPDX-License-Identifier: Apache-2.0
// What the light of area lights needs of a shading point, whatever the light: the frame of its
// normal, and its GGX lobe as a linearly transformed cosine (ggx_fit.h).
#ifndef KILOLUX_SHARED_AREA_AREA_LOBE_H
#define KILOLUX_SHARED_AREA_AREA_LOBE_H
#include "kernels/shared/area/ggx_fit.h"
#include "kernels/shared/lobes/ggx.h"
#include "kernels/shared/types.h"

#if defined(__cplusplus)
namespace kilolux {
#endif

// +z is the normal, the eye in the plane of x and z.
SHARED_PLAIN_STRUCT(AreaFrame) {
    FV3 x, y, z;  // unit
    FV eye_x;     // the direction to the eye
    FV eye_z;
};

// The frame of a unit normal. `across`: n x v, where it has a direction.
SHARED_FN AreaFrame make_area_frame(FV3 normal, FV3 to_eye) {
    FV3 across = cross3(normal, to_eye);
    // An eye straight ahead: any direction serves, here normal x (1, 0, 0) or normal x (0, 1, 0).
    MASK ahead = dot3(across, across) < fv(1e-12f);
    MASK sideways = normal.x * normal.x > fv(0.5f);
    across.x = lane_select(ahead, lane_select(sideways, -normal.z, fv(0.0f)), across.x);
    across.y = lane_select(ahead, lane_select(sideways, fv(0.0f), normal.z), across.y);
    across.z = lane_select(ahead, lane_select(sideways, normal.x, -normal.y), across.z);
    AreaFrame frame;
    frame.z = normal;
    // Twice the cross product with the normal: short products n x v are not quite perpendicular.
    frame.x = cross3(scale3(across, lane_rsqrt(max(dot3(across, across), fv(1e-30f)))), normal);
    frame.y = cross3(normal, frame.x);
    frame.eye_x = dot3(frame.x, to_eye);
    frame.eye_z = dot3(normal, to_eye);
    return frame;
}

SHARED_FN FV3 to_frame(AreaFrame frame, FV3 v) {
    return fv3(dot3(frame.x, v), dot3(frame.y, v), dot3(frame.z, v));
}

// A lobe D V n.l as albedo * transformed cosine.
SHARED_PLAIN_STRUCT(AreaLobe) {
    FV along, tilt, across;  // of ggx_fit.h
    FV albedo;               // the integral of D V n.l
    FV rise;                 // the mean of Schlick's (1 - v.h)^5 over the lobe
    FV inverse_density;      // 1 / (2 albedo along across)
#if HAS_ANISOTROPY
    FV tangent_x, tangent_y;  // in the frame
    // symmetric 2x2 matrix that scales along and across the tangent
    FV stretch_xx, stretch_xy, stretch_yy;
#endif
};

// `slope`: of the lobe in the plane of normal and eye, alpha where it is round.
SHARED_FN AreaLobe make_area_lobe(GgxLobe lobe, FV slope) {
    FV one = fv(1.0f), n_dot_v = min(lobe.n_dot_v, one);
    FV alpha = min(slope, one), roughness = lane_sqrt(alpha);
    FV wide2 = fv(GGX_SPREAD2) * (alpha * alpha);
    FV spread2 = fma(n_dot_v, n_dot_v, wide2);
    FV inverse = lane_rsqrt(spread2);
    FV spread = spread2 * inverse, x = n_dot_v * inverse, rest = wide2 * (inverse * inverse);
    FV narrow = fv(0.5f) / lobe.alpha;
    FV sine = lane_sqrt(max(fma(-n_dot_v, n_dot_v, one), fv(0.0f)));
    AreaLobe area;
    area.along = spread2 * narrow * fma(rest, fit_along(x, roughness), one);
    area.tilt = sine * spread * narrow * fma(rest, fit_tilt(x, roughness), one);
    area.across = narrow * fma(rest, fit_across(x, roughness), one);
    area.albedo = fma(rest, fit_albedo(x, alpha), one);
    FV cosine = spread * fma(rest, fit_half(x, roughness), one);
    area.rise = schlick_rise(one - cosine);
    area.inverse_density = fv(0.5f) / (area.albedo * area.along * area.across);
#if HAS_ANISOTROPY
    area.tangent_x = area.tangent_y = area.stretch_xy = fv(0.0f);
    area.stretch_xx = area.stretch_yy = one;
#endif
    return area;
}

#if HAS_ANISOTROPY
// A lobe of the slopes at, ab along and across a tangent: the transformed light of a round lobe of
// alpha = sqrt(at ab), times alpha / at along the tangent and alpha / ab across it. Exact for
// narrow lobes. Elsewhere the transform is that of the slope in the plane of the eye.
SHARED_FN AreaLobe stretched_area_lobe(GgxLobe lobe, AreaFrame frame) {
    FV across = lane_sqrt(lobe.alpha2);
    FV shrink = across / lobe.alpha, grow = lobe.alpha / across;
    FV x = dot3(frame.x, lobe.tangent), y = dot3(frame.y, lobe.tangent);
    FV slope_x = lobe.alpha * grow * x, slope_y = across * y;
    AreaLobe area = make_area_lobe(lobe, lane_sqrt(fma(slope_x, slope_x, slope_y * slope_y)));
    FV less = shrink - grow;
    area.tangent_x = x;
    area.tangent_y = y;
    area.stretch_xx = fma(x * x, less, grow);
    area.stretch_xy = x * y * less;
    area.stretch_yy = fma(y * y, less, grow);
    return area;
}
#endif

// A vector of the frame in the space where the lobe is a cosine.
SHARED_FN FV3 transformed(AreaLobe area, FV3 v) {
    FV x = fma(area.tilt, v.z, area.along * v.x), y = area.across * v.y;
#if HAS_ANISOTROPY
    return fv3(fma(area.stretch_xx, x, area.stretch_xy * y),
               fma(area.stretch_xy, x, area.stretch_yy * y), v.z);
#else
    return fv3(x, y, v.z);
#endif
}

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
