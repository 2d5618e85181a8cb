// SPDX-License-Identifier: Apache-2.0
// The irradiance of parallelograms and triangles of luminance 1: the integral of cos(theta) over
// the solid angle of the part above the horizon [sr], at most pi. The surface point is the origin,
// its normal +z. A light shines to the side of half_x x half_y; behind it the result is 0. Any
// linear map of a light is one of these lights too, so linearly transformed cosines use this text.
//
// A light above the horizon: Lambert's sum over its edges. Its terms cancel where the light is
// small or narrow as seen from the point, so two other forms take over there: four samples of
// Gauss's rule for small lights, and exact differences of the terms of opposite edges for narrow
// ones. A light that the horizon cuts: each edge is cut, and the horizon adds one.
#ifndef KILOLUX_SHARED_AREA_POLYGON_LIGHT_H
#define KILOLUX_SHARED_AREA_POLYGON_LIGHT_H
#include "kernels/shared/types.h"

// Above these squares of size / distance the sum over edges is used. Both forms have their largest
// errors there: tests/measure/area/area_cosine_test.cpp prints them.
#define SMALL_LIGHT 0.004f
#define SMALL_CUT_LIGHT 0.001f
// Below this square of width / distance a light is narrow.
#define NARROW_LIGHT 1e-3f
// Squares of lengths below this one count as 0 [m^2].
#define SMALLEST_SQUARE 1e-36f

#if defined(__cplusplus)
namespace kilolux {
#endif

// The edges of a light from its first to its fourth corner: offsets from its centre.
SHARED_PLAIN_STRUCT(Corners) { FV3 a, b, c, d; };

// angle / sin(angle) for x = cos(angle) in [0, 1], within 5e-7.
SHARED_FN FV angle_over_sine(FV x) {
    FV s = fma(x, fv(-0.0270813033f), fv(0.137527883f));
    s = fma(s, x, fv(-0.326136649f));
    s = fma(s, x, fv(0.510588884f));
    s = fma(s, x, fv(-0.649177909f));
    s = fma(s, x, fv(0.783392727f));
    s = fma(s, x, fv(-0.999909759f));
    return fma(s, x, fv(1.57079566f));
}

SHARED_FN FV inverse_length(FV square) { return lane_rsqrt(max(square, fv(SMALLEST_SQUARE))); }

// The term of an edge whose angle is more than 90 degrees: x = -cos(angle), weight as for x.
SHARED_FN FV obtuse_edge(FV3 p, FV3 q, FV weight) {
    FV3 across = cross3(p, q);
    return fma(fv(3.14159265f), inverse_length(dot3(across, across)), -weight) * across.z;
}

// Twice the term of the edge from p to q, whose inverse lengths have the product `inverse`.
SHARED_FN FV edge_term(FV3 p, FV3 q, FV inverse) {
    FV x = dot3(p, q) * inverse;
    FV weight = angle_over_sine(min(max(x, -x), fv(1.0f))) * inverse;
    FV term = weight * fma(p.x, q.y, -(p.y * q.x));
    if (lane_any(x < 0.0f)) term = lane_select(x < 0.0f, obtuse_edge(p, q, weight), term);
    return term;
}

SHARED_FN FV any_edge(FV3 p, FV3 q) {
    return edge_term(p, q, inverse_length(dot3(p, p)) * inverse_length(dot3(q, q)));
}

// z / r^4 at center + offset, times `scale`.
SHARED_FN FV sample_of(FV3 point, FV scale) {
    FV inverse = lane_divide(fv(1.0f), max(dot3(point, point), fv(SMALLEST_SQUARE)));
    return (point.z * inverse) * (scale * inverse);
}

// Four samples at center +- x +- y, each of weight 1.
SHARED_FN FV four_samples(FV3 center, FV3 x, FV3 y, FV scale) {
    FV3 left = sub3(center, x), right = add3(center, x);
    return (sample_of(sub3(left, y), scale) + sample_of(add3(left, y), scale)) +
           (sample_of(sub3(right, y), scale) + sample_of(add3(right, y), scale));
}

// The offset where the edge from p to q meets the horizon; center_z: the height of the centre.
SHARED_FN FV3 horizon_point(FV center_z, FV3 p, FV3 q) {
    FV from = center_z + p.z, to = center_z + q.z;
    FV rise = from - to;
    FV t = lane_divide(from, lane_select(max(rise, -rise) < 1e-37f, fv(1.0f), rise));
    t = max(min(t, fv(1.0f)), fv(0.0f));
    return fv3(fma(q.x - p.x, t, p.x), fma(q.y - p.y, t, p.y), -center_z);
}

// 1 where a point is below the horizon, else 0.
SHARED_FN FV below_horizon(FV3 center, FV3 offset) {
    return lane_select(center.z + offset.z < 0.0f, fv(1.0f), fv(0.0f));
}

// Sums over the edges of the part above the horizon. near: Lambert's, twice; far: three samples in
// each triangle between an edge and a common point.
SHARED_PLAIN_STRUCT(EdgeSums) { FV near, far; };

// The part above the horizon of the edge from p to q, which meets the horizon in `cut`. `pivot`:
// the common point.
SHARED_FN EdgeSums cut_edge(FV3 center, FV3 p, FV3 q, FV3 cut, FV3 pivot) {
    FV p_below = below_horizon(center, p), q_below = below_horizon(center, q);
    p = select3(p_below > 0.0f, cut, p);
    q = select3(q_below > 0.0f, cut, q);
    FV above = fma(-p_below, q_below, fv(1.0f));
    FV3 first = add3(center, pivot);
    FV3 to_p = scale3(sub3(p, pivot), fv(0.5f)), to_q = scale3(sub3(q, pivot), fv(0.5f));
    FV third = dot3(center, cross3(to_p, to_q)) * (above * (4.0f / 3.0f));
    EdgeSums sums;
    sums.near = any_edge(add3(center, p), add3(center, q)) * above;
    sums.far = sample_of(add3(first, add3(to_p, to_q)), third) +
               (sample_of(add3(first, to_p), third) + sample_of(add3(first, to_q), third));
    return sums;
}

SHARED_FN EdgeSums add_edges(EdgeSums a, EdgeSums b) {
    a.near += b.near;
    a.far += b.far;
    return a;
}

// Of a light that the horizon cuts.
SHARED_FN EdgeSums cut_polygon(FV3 center, Corners at) {
    FV a = below_horizon(center, at.a), b = below_horizon(center, at.b);
    FV c = below_horizon(center, at.c), d = below_horizon(center, at.d);
    FV3 ab = horizon_point(center.z, at.a, at.b), bc = horizon_point(center.z, at.b, at.c);
    FV3 cd = horizon_point(center.z, at.c, at.d), da = horizon_point(center.z, at.d, at.a);
    // A convex outline sets once and rises once.
    FV3 set = select3(b > a, ab, select3(c > b, bc, select3(d > c, cd, da)));
    FV3 rise = select3(b < a, ab, select3(c < b, bc, select3(d < c, cd, da)));
    EdgeSums sums = add_edges(
        add_edges(cut_edge(center, at.a, at.b, ab, set), cut_edge(center, at.b, at.c, bc, set)),
        add_edges(cut_edge(center, at.c, at.d, cd, set), cut_edge(center, at.d, at.a, da, set)));
    sums.near += any_edge(add3(center, set), add3(center, rise));
    return sums;
}

// `whole`: the irradiance without a horizon, right where no corner is below. `square`: of the size.
SHARED_FN FV above_horizon(FV whole, FV square, FV3 center, Corners at) {
    FV low = min(min(at.a.z, at.b.z), min(at.c.z, at.d.z)) + center.z;
    if (lane_any(low < 0.0f)) {
        EdgeSums sums = cut_polygon(center, at);
        MASK small = square < dot3(center, center) * SMALL_CUT_LIGHT;
        FV cut = lane_select(small, sums.far, sums.near) * -0.5f;
        FV high = max(max(at.a.z, at.b.z), max(at.c.z, at.d.z)) + center.z;
        whole = lane_select(low < 0.0f, lane_select(high > 0.0f, cut, fv(0.0f)), whole);
    }
    return max(min(whole, fv(3.14159265f)), fv(0.0f));
}

// Lambert's sum, times -2, of the parallelogram or, with c = d, triangle with these corners.
SHARED_FN FV edge_sum(FV3 a, FV3 b, FV3 c, FV3 d) {
    FV at_a = inverse_length(dot3(a, a)), at_b = inverse_length(dot3(b, b));
    FV at_c = inverse_length(dot3(c, c)), at_d = inverse_length(dot3(d, d));
    return (edge_term(a, b, at_a * at_b) + edge_term(b, c, at_b * at_c)) +
           (edge_term(c, d, at_c * at_d) + edge_term(d, a, at_d * at_a));
}

// Centre and half sides of a parallelogram.
SHARED_FN FV parallelogram_cosine(FV3 center, FV3 half_x, FV3 half_y) {
    FV3 sum = add3(half_x, half_y), difference = sub3(half_x, half_y);
    FV square = dot3(half_x, half_x) + dot3(half_y, half_y);
    MASK large = square > dot3(center, center) * SMALL_LIGHT;
    FV whole =
        four_samples(center, scale3(half_x, fv(0.577350269f)), scale3(half_y, fv(0.577350269f)),
                     -dot3(center, cross3(half_x, half_y)));
    if (lane_any(large)) {
        FV edges = edge_sum(sub3(center, sum), add3(center, difference), add3(center, sum),
                            sub3(center, difference));
        whole = lane_select(large, edges * -0.5f, whole);
    }
    Corners at;
    at.a = scale3(sum, fv(-1.0f));
    at.b = difference;
    at.c = sum;
    at.d = scale3(difference, fv(-1.0f));
    return above_horizon(whole, square, center, at);
}

// Centroid and the edges from the first corner to the second and third of a triangle.
SHARED_FN FV triangle_cosine(FV3 center, FV3 edge_x, FV3 edge_y) {
    Corners at;
    at.a = scale3(add3(edge_x, edge_y), fv(-1.0f / 3.0f));
    at.b = add3(at.a, edge_x);
    at.c = add3(at.a, edge_y);
    at.d = at.c;
    FV square = dot3(edge_x, edge_x) + dot3(edge_y, edge_y);
    MASK large = square > dot3(center, center) * (4.0f * SMALL_LIGHT);
    // Two samples on each of two lines parallel to edge_y.
    FV scale = -dot3(center, cross3(edge_x, edge_y));
    FV3 first = add3(center, at.a), left = add3(first, scale3(edge_x, fv(0.155051026f)));
    FV3 right = add3(first, scale3(edge_x, fv(0.644948974f)));
    FV whole = sample_of(add3(left, scale3(edge_y, fv(0.178558726f))), scale * 0.159020691f) +
               sample_of(add3(left, scale3(edge_y, fv(0.666390246f))), scale * 0.159020691f) +
               (sample_of(add3(right, scale3(edge_y, fv(0.0750311102f))), scale * 0.0909793091f) +
                sample_of(add3(right, scale3(edge_y, fv(0.280019916f))), scale * 0.0909793091f));
    if (lane_any(large)) {
        FV3 c = add3(center, at.c);
        whole = lane_select(large, edge_sum(first, add3(center, at.b), c, c) * -0.5f, whole);
    }
    return above_horizon(whole, square * 0.25f, center, at);
}

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
