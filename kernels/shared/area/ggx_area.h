// SPDX-License-Identifier: Apache-2.0
// GGX light of area lights: linearly transformed cosines (Heitz et al. 2016), which become the true
// lobe where the light is small.
//
//   integral of D V n.l over the light = albedo / pi * E(transformed light) * f,
//
// E: irradiance of luminance 1. f corrects the fit at one typical point of the light, near the mean
// of its points weighted by the transformed cosine: R is the true lobe D V n.l / the transformed
// cosine there, w its weight.
//   f = 1 + w (R - 1) where R < 1, else 1 / (1 + w (1 / R - 1)):
// between 1 - w and 1 / (1 - w), and smooth at R = 1.
//   w = (1 - E / pi) / (1 + s^2 / 4), s: size of the transformed light / distance,
// is 1 for small lights and 0 for one that fills the lobe. Form and constants were chosen by the
// errors of host/measure/reference/area/ggx_area_error.md.
#ifndef KILOLUX_SHARED_AREA_GGX_AREA_H
#define KILOLUX_SHARED_AREA_GGX_AREA_H
#include "kernels/shared/area/area_lobe.h"
#include "kernels/shared/area/area_shape.h"
#include "kernels/shared/area/polygon_light.h"
#include "kernels/shared/area/round_light.h"
#include "kernels/shared/lobes/ggx.h"
#include "kernels/shared/types.h"

#if defined(__cplusplus)
namespace kilolux {
#endif

// A light in some frame about a surface point: its centre is relative to the point. A sphere is the
// disk that fills the same solid angle.
SHARED_PLAIN_STRUCT(FramedLight) {
    uint kind;
    FlatLight at;
};

// The light of a row with a size, its centre at `v`, in the row's axes. A light of two sides turns
// the one that shines on the point to it.
SHARED_FN FramedLight seen_light(FV3 v, LightShape shape) {
    FramedLight light;
    light.kind = shape_kind(shape);
    light.at.center = v;
    light.at.half_x = fv3(fv(shape.half_x.x), fv(shape.half_x.y), fv(shape.half_x.z));
    light.at.half_y = fv3(fv(shape.half_y.x), fv(shape.half_y.y), fv(shape.half_y.z));
    if (light.kind == SHAPE_SPHERE) {
        light.at = sphere_disk(v, lane_sqrt(dot3(light.at.half_x, light.at.half_x)));
    } else if (shines_both_ways(shape)) {
        FV behind = dot3(v, cross3(light.at.half_x, light.at.half_y));
        FV3 x = light.at.half_x, y = light.at.half_y;  // exchanged, they shine the other way
        light.at.half_x = select3(behind > fv(0.0f), y, x);
        light.at.half_y = select3(behind > fv(0.0f), x, y);
    }
    return light;
}

SHARED_FN FramedLight light_in_frame(AreaFrame frame, FramedLight light) {
    light.at.center = to_frame(frame, light.at.center);
    light.at.half_x = to_frame(frame, light.at.half_x);
    light.at.half_y = to_frame(frame, light.at.half_y);
    return light;
}

// The irradiance of luminance 1 on a surface of normal +z [sr]; is_lobe: of a transformed light.
SHARED_FN FV area_irradiance(FramedLight light, bool is_lobe) {
    FlatLight at = light.at;
    if (light.kind == SHAPE_RECTANGLE) {
        return parallelogram_irradiance(at.center, at.half_x, at.half_y, is_lobe);
    }
    if (light.kind == SHAPE_TRIANGLE) {
        return triangle_irradiance(at.center, at.half_x, at.half_y, is_lobe);
    }
    if (light.kind == SHAPE_SPHERE && !is_lobe) return facing_disk_irradiance(at.center, at.half_x);
    return disk_irradiance(at.center, at.half_x, at.half_y, is_lobe);
}

// As a parallelogram, by its half sides: of a triangle the one whose points have its variances.
SHARED_FN FlatLight equal_variance_parallelogram(FramedLight light) {
    FlatLight at = light.at;
    if (light.kind == SHAPE_TRIANGLE) {
        FV3 x = at.half_x, y = at.half_y;
        at.half_x = scale3(sub3(x, y), fv(0.353553391f));  // 1 / sqrt(8)
        at.half_y = scale3(add3(x, y), fv(0.204124145f));  // 1 / sqrt(24)
    }
    return at;
}

// Where, from -1 to 1 along a half side, the mean of points of the weight z / distance^4 lies: to
// first order in the side's length, and nearest to the origin for long sides.
SHARED_FN FV typical_offset(FV3 center, FV3 side, FV center2, FV side2, FV inverse_variance) {
    // A side of which a part is below the horizon counts as one that touches it.
    FV z = max(max(center.z, max(side.z, -side.z)), fv(1e-12f));
    FV pull = fma(fv(0.25f) * center2, side.z, -(dot3(center, side) * z));
    return lane_divide(pull, max(z * fma(inverse_variance, center2, side2), fv(1e-30f)));
}

SHARED_PLAIN_STRUCT(TypicalPoint) {
    FV x, y;   // in half sides
    FV size2;  // |half_x|^2 + |half_y|^2
};

// The typical point of the cosine lobe's light. inverse_variance: 1 / (4 variance) of points along
// a half side.
SHARED_FN TypicalPoint typical_point(FlatLight at, FV inverse_variance) {
    FV center2 = dot3(at.center, at.center);
    FV x2 = dot3(at.half_x, at.half_x), y2 = dot3(at.half_y, at.half_y);
    TypicalPoint point;
    point.x = typical_offset(at.center, at.half_x, center2, x2, inverse_variance);
    point.y = typical_offset(at.center, at.half_y, center2, y2, inverse_variance);
    point.size2 = x2 + y2;
    return point;
}

// 1 / (4 variance) of points along a half side.
SHARED_FN FV inverse_variance_of(FramedLight light) {
    return fv(light.kind == SHAPE_DISK || light.kind == SHAPE_SPHERE ? 1.0f : 0.75f);
}

SHARED_FN FV3 point_of(FlatLight at, TypicalPoint point) {
    return fv3(fma(point.x, at.half_x.x, fma(point.y, at.half_y.x, at.center.x)),
               fma(point.x, at.half_x.y, fma(point.y, at.half_y.y, at.center.y)),
               fma(point.x, at.half_x.z, fma(point.y, at.half_y.z, at.center.z)));
}

// A point of a light, or one above it where the light may be below the horizon.
SHARED_FN FV3 lifted_vector(FlatLight at, FV3 v) {
    // Where the horizon cuts the light, the mean height of the rest is about half of the largest;
    // less where it cuts little, so that nothing jumps.
    FV reach = max(at.half_x.z, -at.half_x.z) + max(at.half_y.z, -at.half_y.z);
    FV least = min(fv(0.5f) * (reach + at.center.z), fv(2.0f) * (reach - at.center.z));
    v.z = max(v.z, max(least, fv(0.0f)));
    return v;
}

// A light's typical point, not below the horizon.
SHARED_FN FV3 typical_vector(FramedLight light, TypicalPoint point) {
    FlatLight at = equal_variance_parallelogram(light);
    return lifted_vector(at, point_of(at, point));
}

// The fraction of 2 pi D V, over that of the transformed cosine, in a direction of the frame.
SHARED_PLAIN_STRUCT(LobeRatio) {
    FV over, below;
    FV rise;  // Schlick's (1 - v.h)^5
};

// q2: the square of the transformed direction's length.
SHARED_FN LobeRatio lobe_ratio(AreaFrame frame, GgxLobe lobe, AreaLobe area, FV3 l, FV q2) {
    HalfVector half_way;
    half_way.h = fv3(frame.eye_x + l.x, l.y, frame.eye_z + l.z);
    half_way.nxh = fv3(-half_way.h.y, half_way.h.x, fv(0.0f));
    half_way.sin2 = fma(half_way.h.x, half_way.h.x, half_way.h.y * half_way.h.y);
    half_way.hh = max(fma(half_way.h.z, half_way.h.z, half_way.sin2), fv(1e-12f));
    half_way.h4 = half_way.hh * half_way.hh;
    FV ggx = round_ggx(lobe, half_way), smith_l;
#if HAS_ANISOTROPY
    FV b_dot_h = fma(area.tangent_x, half_way.nxh.x, area.tangent_y * half_way.nxh.y);
    ggx = fma(b_dot_h * b_dot_h, lobe.rise, ggx);
    smith_l = stretched_smith(lobe, l.z, fma(area.tangent_x, l.x, area.tangent_y * l.y));
#else
    smith_l = lane_sqrt(smith_square(lobe, l.z));
#endif
    LobeRatio ratio;
    ratio.over = half_way.h4 * (q2 * q2) * area.inverse_density;
    ratio.below = ggx * ggx * fma(l.z, lobe.smith_v, lobe.n_dot_v * smith_l);
    ratio.rise = schlick_rise(fma(fv(-0.5f), lane_sqrt(half_way.hh), fv(1.0f)));
    return ratio;
}

// f of the head of this file for R = over / below.
SHARED_FN FV bounded_ratio(FV over, FV below, FV weight) {
    FV rest = fv(1.0f) - weight;
    MASK large = over > below;
    FV most = max(over, below);
    FV mixed = fma(most, rest, min(over, below) * weight);
    return lane_divide(lane_select(large, most, mixed), lane_select(large, mixed, most));
}

// 2 pi times the integral of a lobe over a light of luminance 1, and the mean of Schlick's
// (1 - v.h)^5 over that.
SHARED_PLAIN_STRUCT(LobeLight) {
    FV light;
    FV rise;
};

// `light`: in the frame of the lobe's normal.
SHARED_FN LobeLight area_ggx(AreaFrame frame, GgxLobe lobe, AreaLobe area, FramedLight light) {
    FramedLight bent = light;
    bent.at.center = transformed(area, light.at.center);
    bent.at.half_x = transformed(area, light.at.half_x);
    bent.at.half_y = transformed(area, light.at.half_y);
    FV cosine = area_irradiance(bent, true);
    TypicalPoint point =
        typical_point(equal_variance_parallelogram(bent), inverse_variance_of(light));
    FV3 v = typical_vector(light, point);
    FV inverse = lane_rsqrt(max(dot3(v, v), fv(1e-30f)));
    FV3 l = scale3(v, inverse);
    FV3 q = transformed(area, l);
    FV q2 = dot3(q, q);
    LobeRatio ratio = lobe_ratio(frame, lobe, area, l, q2);
    FV covered = cosine * fv(0.318309886f);
    FV near2 = fma(fv(0.25f) * point.size2, inverse * inverse, q2);
    FV weight = (fv(1.0f) - covered) * lane_divide(q2, max(near2, fv(1e-30f)));
    LobeLight sent;
    sent.light = fv(2.0f) * area.albedo * cosine * bounded_ratio(ratio.over, ratio.below, weight);
    sent.rise = fma(covered, area.rise - ratio.rise, ratio.rise);
    return sent;
}

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
