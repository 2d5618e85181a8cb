// SPDX-License-Identifier: Apache-2.0
// The irradiance of parallelograms and triangles of luminance 1: the integral of cos(theta) over
// the solid angle of the part above the horizon [sr], at most pi. The surface point is the origin,
// its normal +z. A light shines to the side of half_x x half_y; behind it the result is 0. Any
// linear map of a light is one of these lights too, so linearly transformed cosines use this text.
//
// A light above the horizon: Lambert's sum over its edges. Its terms cancel where the light is
// small or narrow as seen from the point. Small lights have four samples of Gauss's rule instead,
// narrow ones the differences of the edges' weights from that of the centre. A light that the
// horizon cuts: each edge is cut, and the horizon adds one.
#ifndef KILOLUX_SHARED_AREA_POLYGON_LIGHT_H
#define KILOLUX_SHARED_AREA_POLYGON_LIGHT_H
#include "kernels/shared/types.h"

// Below this square of size / distance samples are used. Both forms have their largest errors
// there: tests/measure/area/area_cosine_test.cpp prints them.
#define SMALL_LIGHT 0.005f
#define SMALL_TRIANGLE 0.003f
// Limit for transformed lights. It is larger because the fit errs more than four samples do. It
// also applies to lights cut by the horizon.
#define SMALL_LOBE_LIGHT 0.012f
// Below this one distant_edge can be used, and below the next it is where the horizon cuts.
#define DISTANT_LIGHT 0.1f
#define DISTANT_CUT_LIGHT 8e-3f
// Below this square of width / distance a light is narrow.
#define NARROW_LIGHT 2e-4f
#define NARROW_TRIANGLE 3e-3f
// Squares of lengths below this one count as 0 [m^2].
#define SMALLEST_SQUARE 1e-36f

#if defined(__cplusplus)
namespace kilolux {
#endif

// The corners of a light in the order of its outline: offsets from its centre.
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

// z / r^4 at a point, times `scale`; 0 below the horizon.
SHARED_FN FV sample_of(FV3 point, FV scale) {
    FV inverse = lane_divide(fv(1.0f), max(dot3(point, point), fv(SMALLEST_SQUARE)));
    return (max(point.z, fv(0.0f)) * inverse) * (scale * inverse);
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

// (angle / sin(angle) - 1) / v for v = 1 - cos(angle) in [0, 0.5], within 2e-6.
SHARED_FN FV angle_excess(FV v) {
    FV s = fma(v, fv(0.0218729414f), fv(0.0202667844f));
    s = fma(s, v, fv(0.0581143759f));
    s = fma(s, v, fv(0.133270785f));
    return fma(s, v, fv(0.333333969f));
}

// As edge_term from center + p to center + q, times |center|^2. Omits the centre's weight times the
// edge: over a closed outline these terms sum to 0. For offsets up to half of the distance. center,
// p and q in units of |center|.
SHARED_FN FV distant_edge(FV3 center, FV3 p, FV3 q) {
    FV to_p = dot3(p, add3(add3(center, center), p));  // |center + p|^2 - 1
    FV to_q = dot3(q, add3(add3(center, center), q));
    FV beyond = fma(to_p, to_q, to_p + to_q);
    FV3 edge = sub3(q, p), between = cross3(p, q);
    FV3 across = add3(cross3(center, edge), between);
    FV inverse2 = lane_divide(fv(1.0f), max(1.0f + beyond, fv(1e-3f)));
    FV inverse = lane_sqrt(inverse2);
    FV sine2 = min(dot3(across, across) * inverse2, fv(0.75f));
    FV v = lane_divide(sine2, 1.0f + lane_sqrt(1.0f - sine2));
    FV more = lane_divide(-beyond * inverse2, 1.0f + inverse);  // inverse - 1
    more = fma(v * angle_excess(v), inverse, more);
    return fma(more, across.z, between.z);
}

// The outline of a light that the horizon cuts: offsets from its centre where it goes down through
// the horizon and where it comes up. A convex outline does so once.
SHARED_PLAIN_STRUCT(HorizonCut) { FV3 set, rise; };

SHARED_FN HorizonCut cut_at_horizon(FV3 center, Corners at) {
    FV a = below_horizon(center, at.a), b = below_horizon(center, at.b);
    FV c = below_horizon(center, at.c), d = below_horizon(center, at.d);
    HorizonCut cut;
    cut.set = horizon_point(center.z,
                            select3(b > a, at.a, select3(c > b, at.b, select3(d > c, at.c, at.d))),
                            select3(b > a, at.b, select3(c > b, at.c, select3(d > c, at.d, at.a))));
    cut.rise = horizon_point(
        center.z, select3(b < a, at.a, select3(c < b, at.b, select3(d < c, at.c, at.d))),
        select3(b < a, at.b, select3(c < b, at.c, select3(d < c, at.d, at.a))));
    return cut;
}

// The part of an edge above the horizon, by distant_edge.
SHARED_FN FV cut_distant_edge(FV3 center, FV3 p, FV3 q, HorizonCut cut) {
    FV p_below = below_horizon(center, p), q_below = below_horizon(center, q);
    FV edge = distant_edge(center, select3(p_below > 0.0f, cut.rise, p),
                           select3(q_below > 0.0f, cut.set, q));
    return edge * fma(-p_below, q_below, fv(1.0f));
}

// The part of the outline above the horizon, and the edge on the horizon.
SHARED_FN FV cut_distant_sum(FV3 center, Corners at) {
    HorizonCut cut = cut_at_horizon(center, at);
    return (cut_distant_edge(center, at.a, at.b, cut) + cut_distant_edge(center, at.b, at.c, cut)) +
           (cut_distant_edge(center, at.c, at.d, cut) + cut_distant_edge(center, at.d, at.a, cut)) +
           distant_edge(center, cut.set, cut.rise);
}

// A point of an outline.
SHARED_PLAIN_STRUCT(Vertex) {
    FV3 at;
    FV inverse;  // 1 / distance
    FV below;    // 1 below the horizon, else 0
};

SHARED_FN Vertex vertex_at(FV3 center, FV3 offset) {
    Vertex v;
    v.at = add3(center, offset);
    v.inverse = inverse_length(dot3(v.at, v.at));
    v.below = lane_select(v.at.z < 0.0f, fv(1.0f), fv(0.0f));
    return v;
}

SHARED_FN Vertex above_or(Vertex v, Vertex on_horizon) {
    MASK below = v.below > 0.0f;
    on_horizon.at = select3(below, on_horizon.at, v.at);
    on_horizon.inverse = lane_select(below, on_horizon.inverse, v.inverse);
    return on_horizon;
}

SHARED_FN FV cut_edge(Vertex p, Vertex q, Vertex set, Vertex rise) {
    Vertex from = above_or(p, rise), to = above_or(q, set);
    return edge_term(from.at, to.at, from.inverse * to.inverse) * fma(-p.below, q.below, fv(1.0f));
}

// As cut_distant_sum by Lambert's sum, times -2.
SHARED_FN FV cut_edge_sum(FV3 center, Corners at) {
    HorizonCut cut = cut_at_horizon(center, at);
    Vertex set = vertex_at(center, cut.set), rise = vertex_at(center, cut.rise);
    Vertex a = vertex_at(center, at.a), b = vertex_at(center, at.b);
    Vertex c = vertex_at(center, at.c), d = vertex_at(center, at.d);
    return (cut_edge(a, b, set, rise) + cut_edge(b, c, set, rise)) +
           (cut_edge(c, d, set, rise) + cut_edge(d, a, set, rise)) +
           edge_term(set.at, rise.at, set.inverse * rise.inverse);
}

// Lambert's sum, times -2, over the corners of a light above the horizon.
SHARED_FN FV edge_sum(FV3 center, Corners at) {
    FV3 a = add3(center, at.a), b = add3(center, at.b), c = add3(center, at.c);
    FV3 d = add3(center, at.d);
    FV by_a = inverse_length(dot3(a, a)), by_b = inverse_length(dot3(b, b));
    FV by_c = inverse_length(dot3(c, c)), by_d = inverse_length(dot3(d, d));
    return (edge_term(a, b, by_a * by_b) + edge_term(b, c, by_b * by_c)) +
           (edge_term(c, d, by_c * by_d) + edge_term(d, a, by_d * by_a));
}

SHARED_FN Corners scale_corners(Corners at, FV s) {
    at.a = scale3(at.a, s);
    at.b = scale3(at.b, s);
    at.c = scale3(at.c, s);
    at.d = scale3(at.d, s);
    return at;
}

// Ways to integrate over a polygon; none where it is below the horizon or seen from behind.
#define BY_NONE (-1.0f)
#define BY_SAMPLES 0.0f
#define BY_EDGES 1.0f
#define BY_CUT_EDGES 2.0f
#define BY_DISTANT_EDGES 3.0f

// square: of the size; area: half_x x half_y of a parallelogram, or as much of a triangle; is_lobe:
// whether SMALL_LOBE_LIGHT holds in place of `limit`.
SHARED_FN FV polygon_way(FV3 center, Corners at, FV square, FV3 area, float limit,
                         float narrow_limit, bool is_lobe) {
    FV low = min(min(at.a.z, at.b.z), min(at.c.z, at.d.z)) + center.z;
    FV high = max(max(at.a.z, at.b.z), max(at.c.z, at.d.z)) + center.z;
    FV distance2 = dot3(center, center);
    MASK distant = square < distance2 * DISTANT_LIGHT;
    MASK narrow = dot3(area, area) < square * distance2 * narrow_limit;
    FV cut = lane_select(narrow, fv(BY_DISTANT_EDGES), fv(BY_CUT_EDGES));
    FV whole = lane_select(narrow, fv(BY_DISTANT_EDGES), fv(BY_EDGES));
    cut = lane_select(distant, cut, fv(BY_CUT_EDGES));
    cut = lane_select(square < distance2 * DISTANT_CUT_LIGHT, fv(BY_DISTANT_EDGES), cut);
    whole = lane_select(distant, whole, fv(BY_EDGES));
    MASK small = square < distance2 * (is_lobe ? SMALL_LOBE_LIGHT : limit);
    whole = lane_select(small, fv(BY_SAMPLES), whole);
    if (is_lobe) cut = lane_select(small, fv(BY_SAMPLES), cut);
    FV way = lane_select(low < 0.0f, cut, whole);
    FV shown = lane_select(dot3(center, area) < 0.0f, high, fv(0.0f));
    return lane_select(shown > 0.0f, way, fv(BY_NONE));
}

// The parallelogram or, with c = d, triangle with these corners; `samples`: its result by samples.
SHARED_FN FV polygon_irradiance(FV3 center, Corners at, FV way, FV samples) {
    FV cosine = samples;
    if (lane_any(way == BY_EDGES))
        cosine = lane_select(way == BY_EDGES, edge_sum(center, at) * -0.5f, cosine);
    if (lane_any(way == BY_CUT_EDGES))
        cosine = lane_select(way == BY_CUT_EDGES, cut_edge_sum(center, at) * -0.5f, cosine);
    if (lane_any(way == BY_DISTANT_EDGES)) {
        FV inverse = inverse_length(dot3(center, center));
        FV sum = cut_distant_sum(scale3(center, inverse), scale_corners(at, inverse));
        cosine = lane_select(way == BY_DISTANT_EDGES, sum * -0.5f, cosine);
    }
    cosine = lane_select(way == BY_NONE, fv(0.0f), cosine);
    return max(min(cosine, fv(3.14159265f)), fv(0.0f));
}

// Centre and half sides of a parallelogram.
SHARED_FN FV parallelogram_irradiance(FV3 center, FV3 half_x, FV3 half_y, bool is_lobe) {
    FV3 area = cross3(half_x, half_y);
    Corners at;
    at.c = add3(half_x, half_y);
    at.b = sub3(half_x, half_y);
    at.a = fv3(-at.c.x, -at.c.y, -at.c.z);
    at.d = fv3(-at.b.x, -at.b.y, -at.b.z);
    FV square = dot3(half_x, half_x) + dot3(half_y, half_y);
    FV way = polygon_way(center, at, square, area, SMALL_LIGHT, NARROW_LIGHT, is_lobe);
    FV samples = fv(0.0f);
    if (lane_any(way == BY_SAMPLES))
        samples = four_samples(center, scale3(half_x, fv(0.577350269f)),
                               scale3(half_y, fv(0.577350269f)), -dot3(center, area));
    return polygon_irradiance(center, at, way, samples);
}

// Two samples on each of two lines parallel to edge_y.
SHARED_FN FV triangle_samples(FV3 corner, FV3 edge_x, FV3 edge_y, FV scale) {
    FV3 left = add3(corner, scale3(edge_x, fv(0.155051026f)));
    FV3 right = add3(corner, scale3(edge_x, fv(0.644948974f)));
    FV of_left = scale * 0.159020691f, of_right = scale * 0.0909793091f;
    return (sample_of(add3(left, scale3(edge_y, fv(0.178558726f))), of_left) +
            sample_of(add3(left, scale3(edge_y, fv(0.666390246f))), of_left)) +
           (sample_of(add3(right, scale3(edge_y, fv(0.0750311102f))), of_right) +
            sample_of(add3(right, scale3(edge_y, fv(0.280019916f))), of_right));
}

// Centroid of a triangle, and its edges from the first corner to the second and third.
SHARED_FN FV triangle_irradiance(FV3 center, FV3 edge_x, FV3 edge_y, bool is_lobe) {
    FV3 area = cross3(edge_x, edge_y);
    Corners at;
    at.a = scale3(add3(edge_x, edge_y), fv(-1.0f / 3.0f));
    at.b = add3(at.a, edge_x);
    at.c = add3(at.a, edge_y);
    at.d = at.c;
    FV square = dot3(edge_x, edge_x) + dot3(edge_y, edge_y);
    FV way = polygon_way(center, at, square, area, SMALL_TRIANGLE, NARROW_TRIANGLE, is_lobe);
    FV samples = fv(0.0f);
    if (lane_any(way == BY_SAMPLES))
        samples = triangle_samples(add3(center, at.a), edge_x, edge_y, -dot3(center, area));
    return polygon_irradiance(center, at, way, samples);
}

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
