// SPDX-License-Identifier: Apache-2.0
// Random points of area lights as a surface point sees them: even in solid angle, or, after some of
// them are rejected, with a density in proportion to the cosine that weighs diffuse light.
//
// Flat shapes are fans of spherical triangles about their first corner (Arvo 1995, "Stratified
// sampling of spherical triangles", in the form of Peters 2021, "BRDF Importance Sampling for
// Polygonal Lights", section 4, with 1 - cos in place of cosines, so that small triangles lose no
// digits). An ellipse is the part of its parallelogram that is not rejected (Gamito 2016, "Solid
// Angle Sampling of Disk and Cylinder Lights"). A sphere is a cone.
#ifndef KILOLUX_SHARED_AREA_SAMPLE_SHAPE_H
#define KILOLUX_SHARED_AREA_SAMPLE_SHAPE_H
#include "kernels/shared/angle.h"
#include "kernels/shared/area/area_shape.h"
#include "kernels/shared/area/axes_beside.h"
#include "kernels/shared/types.h"

#if defined(__cplusplus)
#define IN(T) const T&
#define AT(p) (p)
namespace kilolux {
#endif

// A spherical triangle with a corner at the fan's first one.
SHARED_PLAIN_STRUCT(FanTriangle) {
    FV3 from, to;  // unit directions of its other corners
    // The determinant of the corners, and two sums of their cosines: Peters' parameters.
    FV volume, cosines, one_and_cosine;
    FV solid_angle;  // [sr]
};

// A shape in the axes of a surface point's light vectors, seen from the point.
SHARED_PLAIN_STRUCT(SampledShape) {
    FV3 center;          // from the point [m]
    FV3 normal;          // of the surface, unit
    uint kind;           // SHAPE_*
    FV3 half_x, half_y;  // [m]
    FV3 first;           // unit direction of the first corner; of a sphere's centre
    FanTriangle fan[2];  // of a triangle the second one is empty
    FV cone;             // of a sphere: 1 - cosine of its half angle
    FV distance;         // of the farthest corner; of a sphere's centre [m]
    FV solid_angle;      // of the samples [sr]; 0 where nothing is seen
    FV most;             // no cosine with the normal is larger; 0 or less: none is positive
    FV3 highest;         // a point of the shape that is about highest above the surface [m]
};

// A direction towards a shape.
SHARED_PLAIN_STRUCT(ShapeSample) {
    FV3 to_light;  // from the surface point to the sample [m]
    FV share;  // the probability with which to keep it; 0 below the horizon and beside an ellipse
};

SHARED_FN FV3 lanes3(float4 v) { return fv3(fv(v.x), fv(v.y), fv(v.z)); }

// a + b * s.
SHARED_FN FV3 add_along(FV3 a, FV3 b, FV s) {
    return fv3(fma(b.x, s, a.x), fma(b.y, s, a.y), fma(b.z, s, a.z));
}

// In units of its length; 0 for vectors shorter than 1e-18.
SHARED_FN FV3 unit_direction(FV3 v) { return scale3(v, lane_rsqrt(max(dot3(v, v), fv(1e-36f)))); }

// Solid angle: van Oosterom and Strackee 1983.
SHARED_FN FanTriangle fan_triangle(FV3 first, FV3 from, FV3 to) {
    FanTriangle out;
    FV3 a = sub3(from, first), b = sub3(to, first);
    FV3 c = cross3(a, b);
    FV volume = dot3(first, c);
    out.from = from;
    out.to = to;
    out.volume = max(volume, -volume);
    out.one_and_cosine = fv(1.0f) + dot3(first, from);
    out.cosines = dot3(from, to) + dot3(first, to);
    out.solid_angle = fv(2.0f) * half_turn_angle(out.one_and_cosine + out.cosines, out.volume);
    return out;
}

// A bound of the cosines of convex combinations of unit vectors, whose sum is `sum`. highest,
// lowest: of their products with the normal, and of those with the sum's direction.
SHARED_FN FV most_cosine(FV highest, FV lowest) {
    MASK is_narrow = lowest > fv(0.0625f);
    FV most = highest * fv(1.00001f) / max(lowest, fv(0.0625f)) + fv(1e-6f);
    return lane_select(is_narrow, min(most, fv(1.0f)), fv(1.0f));
}

SHARED_FN FV3 higher(FV3 a, FV3 b, FV3 normal) {
    return select3(dot3(a, normal) < dot3(b, normal), b, a);
}

// Of an ellipse.
SHARED_FN FV3 highest_of_ellipse(SampledShape of) {
    FV x = dot3(of.half_x, of.normal), y = dot3(of.half_y, of.normal);
    FV inverse = lane_rsqrt(max(fma(x, x, y * y), fv(1e-36f)));
    return add_along(add_along(of.center, of.half_x, x * inverse), of.half_y, y * inverse);
}

SHARED_FN SampledShape see_polygon(SampledShape out, FV3 a, FV3 b, FV3 c, FV3 d) {
    FV3 first = unit_direction(a), second = unit_direction(b);
    FV3 third = unit_direction(c), last = unit_direction(d);
    out.first = first;
    out.fan[0] = fan_triangle(first, second, third);
    out.fan[1] = fan_triangle(first, third, last);
    out.solid_angle = out.fan[0].solid_angle + out.fan[1].solid_angle;
    FV3 axis = unit_direction(add3(add3(first, second), add3(third, last)));
    FV lowest =
        min(min(dot3(axis, first), dot3(axis, second)), min(dot3(axis, third), dot3(axis, last)));
    FV3 n = out.normal;
    FV highest = max(max(dot3(n, first), dot3(n, second)), max(dot3(n, third), dot3(n, last)));
    out.most = lane_select(highest > fv(0.0f), most_cosine(highest, lowest), fv(0.0f));
    out.distance = lane_sqrt(max(max(dot3(a, a), dot3(b, b)), max(dot3(c, c), dot3(d, d))));
    out.highest = out.kind == SHAPE_DISK ? highest_of_ellipse(out)
                                         : higher(higher(a, b, n), higher(c, d, n), n);
    return out;
}

// A point inside sees nothing.
SHARED_FN SampledShape see_sphere(SampledShape out, FV radius) {
    FV d2 = max(dot3(out.center, out.center), fv(1e-36f));
    FV inv_d = lane_rsqrt(d2);
    FV sine2 = radius * radius * (inv_d * inv_d);
    FV cosine = lane_sqrt(max(fv(1.0f) - sine2, fv(0.0f)));
    out.first = scale3(out.center, inv_d);
    out.cone = sine2 / (fv(1.0f) + cosine);
    out.distance = d2 * inv_d;
    out.solid_angle = lane_select(sine2 < fv(1.0f), fv(6.283185307f) * out.cone, fv(0.0f));
    // The cosine of the angle between the normal and the cone, and 1 where the cone holds it.
    FV high = min(dot3(out.normal, out.first), fv(1.0f));
    FV across = lane_sqrt(max(fma(-high, high, fv(1.0f)), fv(0.0f)));
    FV beside = fma(high, cosine, across * lane_sqrt(min(sine2, fv(1.0f)))) + fv(1e-6f);
    out.most = lane_select(high >= cosine, fv(1.0f), min(beside, fv(1.0f)));
    out.highest = add_along(out.center, out.normal, radius);
    return out;
}

// half_x, half_y: of the light of kind `kind`, as in LightShape. `center`: from the surface point;
// `normal`: of the surface, unit. All in the same axes.
SHARED_FN SampledShape see_shape(uint kind, FV3 center, FV3 half_x, FV3 half_y, FV3 normal) {
    SampledShape out;
    out.center = center;
    out.normal = normal;
    out.kind = kind;
    out.half_x = half_x;
    out.half_y = half_y;
    if (kind == SHAPE_SPHERE) return see_sphere(out, lane_sqrt(dot3(half_x, half_x)));
    if (kind == SHAPE_TRIANGLE) {
        FV3 a = add_along(center, add3(half_x, half_y), fv(-0.333333333f));
        FV3 c = add3(a, half_y);
        return see_polygon(out, a, add3(a, half_x), c, c);
    }
    FV3 low = sub3(center, half_y), high = add3(center, half_y);
    return see_polygon(out, sub3(low, half_x), add3(low, half_x), add3(high, half_x),
                       sub3(high, half_x));
}

// The unit direction of (u, v) in a fan.
SHARED_FN FV3 fan_direction(IN(SampledShape) of, FV u, FV v) {
    FV angle = u * AT(of).solid_angle;
    FV of_first = AT(of).fan[0].solid_angle;
    MASK second = angle > of_first;
    angle = lane_select(second, angle - of_first, angle);
    FV3 from = select3(second, AT(of).fan[1].from, AT(of).fan[0].from);
    FV3 to = select3(second, AT(of).fan[1].to, AT(of).fan[0].to);
    FV volume = lane_select(second, AT(of).fan[1].volume, AT(of).fan[0].volume);
    FV cosines = lane_select(second, AT(of).fan[1].cosines, AT(of).fan[0].cosines);
    FV one_and = lane_select(second, AT(of).fan[1].one_and_cosine, AT(of).fan[0].one_and_cosine);
    // The triangle (first, from, end) has the angle: `end` mirrors `from` on the plane of `middle`.
    SineCosine half_angle = sine_cosine(min(fv(0.5f) * angle, fv(3.141592654f)));
    FV of_from = fma(volume, half_angle.cosine, -(cosines * half_angle.sine));
    FV3 middle = add_along(scale3(from, of_from), to, one_and * half_angle.sine);
    FV length2 = dot3(middle, middle);
    FV by = fv(2.0f) * dot3(from, middle) / max(length2, fv(1e-30f));
    FV3 end = add_along(scale3(from, fv(-1.0f)), middle, by);
    end = select3(length2 > fv(1e-30f), end, from);
    // The arc from the first corner to `end`, by 1 - cosine.
    FV3 to_end = sub3(end, AT(of).first);
    FV versine = fv(0.5f) * dot3(to_end, to_end);
    FV t = lane_sqrt(v * fma(-v, versine, fv(2.0f)) / max(fv(2.0f) - versine, fv(1e-6f)));
    FV3 out = add_along(AT(of).first, to_end, t);
    return add_along(out, AT(of).first, versine * (t - v));
}

SHARED_FN FV3 cone_direction(IN(SampledShape) of, FV u, FV v) {
    FV versine = u * AT(of).cone;
    FV sine = lane_sqrt(max(versine * (fv(2.0f) - versine), fv(0.0f)));
    SineCosine turn = sine_cosine(fma(v, fv(6.283185307f), fv(-3.141592654f)));
    FV3 n = AT(of).first;
    FV sign = lane_select(n.z < fv(0.0f), fv(-1.0f), fv(1.0f));
    AxesBeside axes = axes_beside(n, sign, fv(-1.0f) / (sign + n.z));
    FV3 out = scale3(n, fv(1.0f) - versine);
    out = add_along(out, axes.x, sine * turn.cosine);
    return add_along(out, axes.y, sine * turn.sine);
}

// The nearer point of a sphere in a direction.
SHARED_FN FV3 sphere_point(IN(SampledShape) of, FV3 direction) {
    FV along = dot3(direction, AT(of).center);
    FV3 aside = add_along(AT(of).center, direction, -along);
    FV radius2 = dot3(AT(of).half_x, AT(of).half_x);
    return scale3(direction, along - lane_sqrt(max(radius2 - dot3(aside, aside), fv(0.0f))));
}

// The point of a flat shape's plane in a direction, no farther than its corners.
SHARED_FN FV3 plane_point(IN(SampledShape) of, FV3 direction) {
    FV3 normal = cross3(AT(of).half_x, AT(of).half_y);
    FV height = dot3(normal, AT(of).center), slope = dot3(normal, direction);
    FV3 farthest = scale3(direction, AT(of).distance);
    FV distance = height / lane_select(slope == fv(0.0f), fv(1e-30f), slope);
    MASK is_near = distance < AT(of).distance;
    return select3(is_near, scale3(direction, max(distance, fv(0.0f))), farthest);
}

// 1 inside the ellipse, else 0. Its half axes need not be perpendicular.
SHARED_FN FV in_ellipse(IN(SampledShape) of, FV3 to_light) {
    FV3 at = sub3(to_light, AT(of).center);
    FV3 normal = cross3(AT(of).half_x, AT(of).half_y);
    FV inverse = fv(1.0f) / max(dot3(normal, normal), fv(1e-36f));
    FV x = dot3(cross3(at, AT(of).half_y), normal) * inverse;
    FV y = dot3(cross3(AT(of).half_x, at), normal) * inverse;
    return lane_select(fma(x, x, y * y) <= fv(1.0f), fv(1.0f), fv(0.0f));
}

// u, v: in [0, 1). Even in solid angle; what is kept by `share` has a density in proportion to the
// cosine with the surface's normal.
SHARED_FN ShapeSample sample_shape(IN(SampledShape) of, FV u, FV v) {
    ShapeSample out;
    bool is_sphere = AT(of).kind == SHAPE_SPHERE;
    FV3 direction;
    if (is_sphere) {
        direction = cone_direction(of, u, v);
        out.to_light = sphere_point(of, direction);
    } else {
        direction = fan_direction(of, u, v);
        out.to_light = plane_point(of, direction);
    }
    FV cosine = max(dot3(direction, AT(of).normal), fv(0.0f));
    out.share = min(cosine / max(AT(of).most, fv(1e-6f)), fv(1.0f));
    if (AT(of).kind == SHAPE_DISK) out.share = out.share * in_ellipse(of, out.to_light);
    return out;
}

#if defined(__cplusplus)
}  // namespace kilolux
#undef IN
#undef AT
#endif
#endif
