// SPDX-License-Identifier: Apache-2.0
// The irradiance of spheres and ellipses of luminance 1, in the frame and unit of polygon_light.h.
// In closed form, but where the horizon cuts a small ellipse: there the cut is that of the circular
// cone about the same axis that touches the horizon with it.
#ifndef KILOLUX_SHARED_AREA_ROUND_LIGHT_H
#define KILOLUX_SHARED_AREA_ROUND_LIGHT_H
#include "kernels/shared/area/axes_beside.h"
#include "kernels/shared/area/polygon_light.h"
#include "kernels/shared/power.h"
#include "kernels/shared/types.h"

#if defined(__cplusplus)
namespace kilolux {
#endif

// (x - atan(x)) / x^3 by the square of x in [0, 1], within 3e-7.
SHARED_FN FV atan_remainder(FV square) {
    FV s = fma(square, fv(-0.00392374350f), fv(0.0202291924f));
    s = fma(s, square, fv(-0.0491975695f));
    s = fma(s, square, fv(0.0802940726f));
    s = fma(s, square, fv(-0.108728476f));
    s = fma(s, square, fv(0.142582670f));
    s = fma(s, square, fv(-0.199987605f));
    return fma(s, square, fv(0.333333254f));
}

// As cone_cosine where the horizon cuts the cone.
SHARED_FN FV cut_cone_cosine(FV axis_z, FV sine2, FV cosine2) {
    FV axis_sine = lane_sqrt(max(fma(-axis_z, axis_z, fv(1.0f)), fv(1e-30f)));
    FV cotangent = lane_sqrt(lane_divide(cosine2, sine2));
    FV y = max(min(lane_divide(-cotangent * axis_z, axis_sine), fv(1.0f)), fv(-1.0f));
    FV w = lane_sqrt((1.0f - y) * (1.0f + y));
    FV angle = w * angle_over_sine(max(y, -y));
    angle = lane_select(y < 0.0f, fv(3.14159265f) - angle, angle);  // acos(y)
    FV across = axis_sine * w;
    // atan(across / cotangent), as the quotient or its inverse, whichever is at most 1, and a rest.
    FV ratio = lane_divide(min(across, cotangent), max(max(across, cotangent), fv(1e-30f)));
    FV rest = ratio * ratio * ratio * atan_remainder(ratio * ratio);
    MASK narrow = across <= cotangent;
    FV straight = lane_select(narrow, ratio, -cotangent * across);
    FV bent = lane_select(narrow, -rest, 1.57079633f - (ratio - rest));
    return fma(axis_z, angle, straight + lane_divide(bent, sine2)) * 0.318309886f;
}

// The irradiance of a circular cone as a share of that with its axis along the normal. axis_z: the
// cosine between both. sine2, cosine2: squares of the sine and cosine of the cone's half angle,
// above 0.
SHARED_FN FV cone_cosine(FV axis_z, FV sine2, FV cosine2) {
    FV share = max(axis_z, fv(0.0f));
    MASK cut = axis_z * axis_z < sine2;
    if (lane_any(cut)) {
        FV part = max(cut_cone_cosine(axis_z, sine2, cosine2), fv(0.0f));
        share = lane_select(cut, part, share);
    }
    return share;
}

// A flat light: its centre, and half_x and half_y as in LightShape.
SHARED_PLAIN_STRUCT(FlatLight) { FV3 center, half_x, half_y; };

// The irradiance of a disk that is perpendicular to the direction to its centre, and shines to the
// origin: of a sphere's solid angle. Exact; 0 for the disk of a sphere around the origin.
SHARED_FN FV facing_disk_irradiance(FV3 center, FV3 half_x) {
    FV distance2 = dot3(center, center), radius2 = dot3(half_x, half_x);
    FV inverse2 = lane_divide(fv(1.0f), max(distance2 + radius2, fv(SMALLEST_SQUARE)));
    FV sine2 = max(radius2 * inverse2, fv(1e-37f));
    FV axis_z = center.z * inverse_length(distance2);
    FV cosine = fv(3.14159265f) * sine2 * cone_cosine(axis_z, sine2, distance2 * inverse2);
    return lane_select(distance2 > fv(0.0f), cosine, fv(0.0f));
}

// The disk that fills the same solid angle as a sphere outside of which the origin is. It shines to
// the origin.
SHARED_FN FlatLight sphere_disk(FV3 center, FV radius) {
    FV square = dot3(center, center);
    FV inverse = inverse_length(square);
    FV share = max(fma(-radius * inverse, radius * inverse, fv(1.0f)), fv(0.0f));
    FV3 axis = scale3(center, inverse);
    FV side = lane_select(axis.z < 0.0f, fv(-1.0f), fv(1.0f));
    AxesBeside axes = axes_beside(axis, side, lane_divide(fv(-1.0f), side + axis.z));
    FV size = radius * lane_sqrt(share);
    FlatLight disk;
    disk.center = scale3(center, share);
    disk.half_y = scale3(axes.x, size);
    disk.half_x = scale3(axes.y, size);
    return disk;
}

// The root above 0 of k^3 + a k^2 + b k - c, whose other roots are below 0, from above: Laguerre.
SHARED_FN FV largest_root(FV k, FV a, FV b, FV c) {
    // Without k^3 the root is above. This start is near where the root is small beside the others.
    FV wide = max(a, fv(0.0f));
    FV below = b + lane_sqrt(max(fma(b, b, 4.0f * wide * c), fv(0.0f)));
    k = lane_select(a > 0.0f, min(k, lane_divide(2.0f * c, max(below, fv(1e-37f)))), k);
    for (int i = 0; i < 2; ++i) {
        FV value = fma(fma(k + a, k, b), k, -c);
        FV slope = fma(fma(fv(3.0f), k, 2.0f * a), k, b);
        FV bend = fma(fv(6.0f), k, 2.0f * a);
        FV root = lane_sqrt(max(fma(4.0f * slope, slope, -6.0f * value * bend), fv(0.0f)));
        FV step = lane_divide(3.0f * value, max(slope + root, fv(1e-37f)));
        k = max(k - step, fv(0.0f));
    }
    return k;
}

// The cone over an ellipse: the axes of the matrix W = half_x half_x^T + half_y half_y^T -
// center center^T. Its eigenvalues are -k, of the cone's axis, and p >= q >= 0: the squares of the
// half axes of the ellipse in which a plane across the axis at the distance sqrt(k) cuts the cone.
SHARED_PLAIN_STRUCT(EllipseCone) {
    FV k, p, q;
    FV axis_z;
    FV spread;  // p a^2 + q b^2 for the components a and b of the normal along the other two axes
    FV faced;   // the irradiance on a surface that faces along the axis [sr]
};

SHARED_FN EllipseCone ellipse_cone(FV3 center, FV3 half_x, FV3 half_y) {
    FV scale = inverse_length(dot3(center, center) + dot3(half_x, half_x) + dot3(half_y, half_y));
    FV3 c = scale3(center, scale), x = scale3(half_x, scale), y = scale3(half_y, scale);
    FV3 area = cross3(x, y), over_x = cross3(c, x), over_y = cross3(c, y);
    FV volume = dot3(c, area), cc = dot3(c, c), size = dot3(x, x) + dot3(y, y);
    FV minors = dot3(area, area) - (dot3(over_x, over_x) + dot3(over_y, over_y));
    FV k = max(largest_root(cc, size - cc, minors, volume * volume), fv(1e-37f));
    // (k + p) (k + q): the slope of the characteristic polynomial.
    FV slope = max(fma(fma(fv(3.0f), k, 2.0f * (size - cc)), k, minors), fv(1e-37f));
    FV cx = dot3(c, x), cy = dot3(c, y);
    // slope * axis axis^T, the adjugate of W + k, times the centre: its z, and its product with it.
    FV along_z = fma(k, fma(k + size, c.z, -fma(cx, x.z, cy * y.z)), volume * area.z);
    FV along = fma(k, fma(k + size, cc, -fma(cx, cx, cy * cy)), volume * volume);
    EllipseCone cone;
    cone.k = k;
    cone.axis_z = max(min(along_z * inverse_length(slope * along), fv(1.0f)), fv(-1.0f));
    cone.faced = fv(-3.14159265f) * volume * inverse_length(k * slope);
    cone.spread = max(fma(k * cone.axis_z, cone.axis_z, fma(x.z, x.z, fma(y.z, y.z, -(c.z * c.z)))),
                      fv(0.0f));
    // p q and p + q, by whichever form does not cancel.
    FV product = volume * lane_divide(volume, k);
    FV sum = lane_select(cc > size, lane_divide(product - minors, k), (size - cc) + k);
    cone.p = fma(sum, fv(0.5f), lane_sqrt(max(fma(0.25f * sum, sum, -product), fv(0.0f))));
    cone.p = max(cone.p, fv(1e-30f));
    cone.q = min(lane_divide(product, cone.p), cone.p);
    return cone;
}

// atan2(cross, dot), from -pi to pi.
SHARED_FN FV turn_of(FV cross, FV dot) {
    FV inverse = inverse_length(fma(cross, cross, dot * dot));
    FV x = min(max(dot, -dot) * inverse, fv(1.0f)), sine = max(cross, -cross) * inverse;
    FV angle = angle_over_sine(x) * sine;
    angle = lane_select(dot < 0.0f, fv(3.14159265f) - angle, angle);
    return lane_select(cross < 0.0f, -angle, angle);
}

// log2((1 + a) (1 - b) / ((1 - a) (1 + b))) for |a|, |b| < 1, of small relative error.
SHARED_FN FV log2_of_quotient(FV a, FV b) {
    FV above = (1.0f + a) * (1.0f - b), below = max((1.0f - a) * (1.0f + b), fv(1e-30f));
    FV f = lane_divide(2.0f * (a - b), above);  // 1 - below / above
    MASK small = max(f, -f) < 0.29f;
    f = max(min(f, fv(0.29f)), fv(-0.29f));
    return lane_select(small, f * log2_slope(f), log2_of(lane_divide(above, below)));
}

// The cone's irradiance where the horizon cuts it: the integral along the outline, which is
// (sqrt(p) cos(f), sqrt(q) sin(f), sqrt(k)) about its axes, and the edge on the horizon.
SHARED_FN FV cut_ellipse_irradiance(EllipseCone cone) {
    FV k = cone.k, p = cone.p, q = cone.q;
    FV pq = max(p - q, p * 1e-6f), pk = p + k, qk = q + k;
    FV side2 = max(fma(-cone.axis_z, cone.axis_z, fv(1.0f)), fv(0.0f));
    FV a2 = max(min(lane_divide(fma(-q, side2, cone.spread), pq), side2), fv(0.0f));
    FV root_p = lane_sqrt(p), root_q = lane_sqrt(q), root_k = lane_sqrt(k);
    FV a = lane_sqrt(a2), b = lane_sqrt(max(side2 - a2, fv(0.0f)));
    // The middle of the part above the horizon, and half of its angle.
    FV x = root_p * a, y = root_q * b;
    FV inverse = inverse_length(fma(x, x, y * y));
    FV c0 = x * inverse, s0 = y * inverse;
    FV c = max(min(-cone.axis_z * root_k * inverse, fv(1.0f)), fv(-1.0f));
    FV s = lane_sqrt((1.0f - c) * (1.0f + c));
    FV from_c = fma(c0, c, s0 * s), from_s = fma(s0, c, -(c0 * s));
    FV to_c = fma(c0, c, -(s0 * s)), to_s = fma(s0, c, c0 * s);
    FV root_pk = lane_sqrt(pk), root_qk = lane_sqrt(qk), root_pq = lane_sqrt(pq);
    // Three integrals: of 1, of the cosine and of the sine, over the square of the distance.
    FV around =
        turn_of(root_pk * root_qk * 2.0f * s * c, fma(pk * from_c, to_c, qk * from_s * to_s));
    around = lane_select(around < 0.0f, around + 6.28318531f, around);
    FV sum = lane_divide(cone.axis_z * root_p * root_q * around, root_pk * root_qk);
    FV e = lane_divide(root_pq, root_pk);
    FV log2 = log2_of_quotient(e * to_s, e * from_s);
    sum -= lane_divide(a * root_q * root_k * 0.346573590f * log2, root_pk * root_pq);
    FV across = turn_of(root_qk * root_pq * (from_c - to_c), fma(pq * from_c, to_c, qk));
    sum -= lane_divide(b * root_p * root_k * across, root_qk * root_pq);
    // The edge on the horizon.
    FV normal = fma(
        a * root_q * root_k, to_s - from_s,
        fma(b * root_p * root_k, from_c - to_c, cone.axis_z * root_p * root_q * (-2.0f * s * c)));
    FV dot = fma(p * from_c, to_c, fma(q * from_s, to_s, k));
    return 0.5f * (sum + turn_of(max(normal, fv(0.0f)), dot));
}

// As disk_irradiance, for lights of any size and at the horizon. `large`: where the integral along
// the outline is used; it cancels in small lights, whose cut is that of the circular cone about the
// same axis that touches the horizon with them.
SHARED_FN FV ellipse_irradiance(FV3 center, FV3 half_x, FV3 half_y, MASK large) {
    EllipseCone cone = ellipse_cone(center, half_x, half_y);
    FV rest = cone.k * fma(-cone.axis_z, cone.axis_z, fv(1.0f));
    FV both = lane_divide(fv(1.0f), max(cone.spread + rest, fv(1e-37f)));
    FV sine2 = max(cone.spread * both, fv(1e-37f));
    FV cosine = cone.faced * cone_cosine(cone.axis_z, sine2, rest * both);
    FV cut = lane_select(large, sine2 - cone.axis_z * cone.axis_z, fv(0.0f));
    if (lane_any(cut > 0.0f))
        cosine = lane_select(cut > 0.0f, cut_ellipse_irradiance(cone), cosine);
    return lane_select(cone.faced > 0.0f, cosine, fv(0.0f));
}

// An ellipse that shines to the side of half_x x half_y. is_lobe: as of polygons.
SHARED_FN FV disk_irradiance(FV3 center, FV3 half_x, FV3 half_y, bool is_lobe) {
    FV square = dot3(half_x, half_x) + dot3(half_y, half_y);
    FV reach2 = fma(half_x.z, half_x.z, half_y.z * half_y.z);
    FV facing = -dot3(center, cross3(half_x, half_y));
    MASK large = square > dot3(center, center) * (is_lobe ? SMALL_LOBE_LIGHT : SMALL_LIGHT);
    MASK low = reach2 > center.z * center.z;
    FV way = lane_select(large, fv(BY_EDGES), fv(BY_SAMPLES));
    if (!is_lobe) way = lane_select(low, fv(BY_EDGES), way);
    FV shown = lane_select(low, facing, lane_select(center.z > 0.0f, facing, fv(0.0f)));
    way = lane_select(shown > 0.0f, way, fv(BY_NONE));
    FV cosine = fv(0.0f);
    if (lane_any(way == BY_SAMPLES)) {
        FV samples = four_samples(center, scale3(half_x, fv(0.5f)), scale3(half_y, fv(0.5f)),
                                  facing * 0.785398163f);
        cosine = lane_select(way == BY_SAMPLES, samples, cosine);
    }
    if (lane_any(way == BY_EDGES)) {
        FV exact = ellipse_irradiance(center, half_x, half_y, large);
        cosine = lane_select(way == BY_EDGES, exact, cosine);
    }
    return max(min(cosine, fv(3.14159265f)), fv(0.0f));
}

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
