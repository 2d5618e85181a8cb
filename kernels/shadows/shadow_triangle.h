// SPDX-License-Identifier: Apache-2.0
// Which triangles stand between a light and points: VW triangles set up at once as affine forms,
// which then any number of points evaluates.
//
// Seen from the light a point lies within a triangle's edges where u_i >= 0 for all i; u_i is the
// product of an edge's plane through the light, v_j x v_k, with the direction to the point. The
// triangle hides the point if, in addition, its plane has the light on one side and the point on
// the other. Rays of one light have their origin in common, so all four are affine in the point.
//
// Each form is divided by a bound of its rounding error (16 * 2^-24 of the products that it sums,
// of which fewer than 10 round), so its sign is certain beyond +-1:
// * edges grant 1 unit: a ray along the common edge or vertex of triangles never slips between
//   them. That widens an edge by 2^-20 of the distance from the light, since its plane is known to
//   twice a float's digits (twofold.h), and by 2^-42 over the sine of its angle with the light:
//   without end where it points at the light. So a ray must pass within SHADOW_NEAR of the
//   triangle's box, too, which is less than what walks grant.
// * the plane asks for 1 unit: a triangle never shades its own points, nor those of its neighbours
//   in the plane. Points that lie less than the unit behind it, 2^-17 of the coordinates, are lit.
// A light so near to a triangle's plane that its side is uncertain is not hidden by it; nor is a
// point of a light with a size within that light's margin of the plane (area_target.h), so that an
// emissive surface and its neighbours in the plane do not hide their own light. So whether
// a triangle hides a point depends on the light, the triangle and the point alone, and not on which
// walk found it.
#ifndef KILOLUX_DEVICE_SHADOW_TRIANGLE_H
#define KILOLUX_DEVICE_SHADOW_TRIANGLE_H
#include "kernels/device/longest_edge.h"
#include "kernels/shadows/shadow_space.h"
#include "kernels/shadows/twofold.h"

#define SHADOW_UNIT (1.0f / (1 << 20))
// Error of the products that twofold_cross sums, relative to them.
#define SHADOW_CUT (1.0f / (1 << 22))
// A share of the largest coordinate of a ray's ends; or, for a directional light, of the scene.
#define SHADOW_NEAR (0.5f * SHADOW_PAD)

// u = g . x + c. For an edge, x is the direction to the point, |x| + |y| + |z| = 1, or, for a
// directional light, the point; for the plane it is the point.
typedef struct ShadowForm {
    FV3 g;
    FV c;
} ShadowForm;

// Boxes of VW triangles [m].
typedef struct LaneBoxes {
    FV3 middle, half_edge;
} LaneBoxes;

// A triangle hides a point where edge[0..2] and plane are all at least -1.
typedef struct ShadowTriangles {
    ShadowForm edge[3];
    ShadowForm plane;
    FV unit[3];  // of the edges
    LaneBoxes box;
} ShadowTriangles;

// The sum of the magnitudes of the products in a x b.
static inline FV products3(FV3 a, FV3 b) {
    return (fabs(a.y * b.z) + fabs(a.z * b.y)) + (fabs(a.z * b.x) + fabs(a.x * b.z)) +
           (fabs(a.x * b.y) + fabs(a.y * b.x));
}

// A bound of the rounding of a form with gradient `g`, which sums `products`, where points have
// size 1.
static inline FV form_unit(FV3 g, FV products) {
    return max(fma(products, fv(SHADOW_CUT), size3(g)) * SHADOW_UNIT, fv(1e-36f));
}

// The plane through the light's position and edge a -> b. a, b: seen from the light.
static inline ShadowForm edge_form(TwofoldVec3 a, TwofoldVec3 b, FV* unit) {
    ShadowForm out;
    out.g = twofold_cross(a, b);
    out.c = fv(0.0f);
    *unit = form_unit(out.g, products3(a.high, b.high));
    return out;
}

// The plane through edge a -> b in direction `towards`, for points of size `extent` at most.
static inline ShadowForm edge_form_along(FV3 a, FV3 b, FV3 towards, float extent, FV* unit) {
    TwofoldVec3 d = twofold_difference(a, b);
    TwofoldVec3 l = {towards, splat3((float3)(0.0f))};
    FV3 s = add3(a, b);
    ShadowForm out;
    out.g = twofold_cross(d, l);
    out.c = -0.5f * dot3(s, out.g);
    FV size = fma(fv(0.5f), size3(s), fv(extent));
    *unit = form_unit(out.g, products3(d.high, l.high)) * size;
    return out;
}

static inline ShadowForm scale_form(ShadowForm f, FV by) {
    f.g = scale3(f.g, by);
    f.c *= by;
    return f;
}

// The triangles' planes and the light's height above them.
typedef struct ShadowPlanes {
    FV3 normal;    // (v1 - v0) x (v2 - v0), v turned
    FV offset;     // normal . v0
    FV unit;       // of normal . p - offset
    FV height;     // the light's, times the normal's length
    MASK is_sure;  // of the height's sign
} ShadowPlanes;

// `v`: corners in shadow space.
static inline ShadowPlanes shadow_planes(const FV3* v, LaneLight light) {
    FV3 t[3] = {v[0], v[1], v[2]};
    turn_from_longest(t);
    FV3 a = sub3(t[1], t[0]);
    FV3 b = sub3(t[2], t[0]);
    FV products = products3(a, b);
    FV size = max(max(size3(t[0]), size3(t[1])), size3(t[2]));
    ShadowPlanes out;
    out.normal = cross3(a, b);
    out.offset = dot3(out.normal, t[0]);
    out.unit = max(products * (size + light.reach) * SHADOW_UNIT, fv(1e-36f));
    FV3 l = light.at;
    FV height_unit = products * SHADOW_UNIT;
    if (light.is_direction) {
        out.height = dot3(out.normal, l);
    } else {
        FV3 from = sub3(l, t[0]);
        out.height = dot3(out.normal, from);
        height_unit = max(height_unit * size3(from), size3(out.normal) * light.margin);
    }
    out.is_sure = lane_mask(fabs(out.height) > max(height_unit, fv(1e-36f)));
    return out;
}

static inline FV larger(FV a, FV b) { return max(fabs(a), fabs(b)); }

// `v`: corners.
static inline LaneBoxes boxes_of(const FV3* v) {
    FV3 low = fv3(min(min(v[0].x, v[1].x), v[2].x), min(min(v[0].y, v[1].y), v[2].y),
                  min(min(v[0].z, v[1].z), v[2].z));
    FV3 high = fv3(max(max(v[0].x, v[1].x), v[2].x), max(max(v[0].y, v[1].y), v[2].y),
                   max(max(v[0].z, v[1].z), v[2].z));
    LaneBoxes out = {scale3(add3(low, high), fv(0.5f)), scale3(sub3(high, low), fv(0.5f))};
    return out;
}

// Whether the rays from points to a light pass boxes: no axis and no cross product of an axis and
// the ray separates them.
static inline MASK passes_box(LaneLight light, FV3 p, LaneBoxes box) {
    FV3 m = sub3(p, box.middle);
    FV3 half_edge = box.half_edge;
    FV3 d = light.at;
    FV size = max(larger(p.x, p.y), max(fabs(p.z), fv(0.5f * light.reach)));
    if (!light.is_direction) {
        size = max(max(larger(p.x, p.y), fabs(p.z)), max(larger(d.x, d.y), fabs(d.z)));
        d = sub3(d, p);
    }
    FV near = size * SHADOW_NEAR;
    FV3 e = fv3(half_edge.x + near, half_edge.y + near, half_edge.z + near);
    MASK passes = lane_mask(fabs(m.y * d.z - m.z * d.y) <= e.y * fabs(d.z) + e.z * fabs(d.y)) &
                  lane_mask(fabs(m.z * d.x - m.x * d.z) <= e.z * fabs(d.x) + e.x * fabs(d.z)) &
                  lane_mask(fabs(m.x * d.y - m.y * d.x) <= e.x * fabs(d.y) + e.y * fabs(d.x));
    // The end at the point; along each axis the ray goes on towards the light.
    passes &= lane_mask(copysign(m.x, m.x * d.x) <= e.x) &
              lane_mask(copysign(m.y, m.y * d.y) <= e.y) &
              lane_mask(copysign(m.z, m.z * d.z) <= e.z);
    if (light.is_direction) return passes;
    FV3 back = add3(m, d);  // the end at the light
    return passes & lane_mask(copysign(back.x, -back.x * d.x) <= e.x) &
           lane_mask(copysign(back.y, -back.y * d.y) <= e.y) &
           lane_mask(copysign(back.z, -back.z * d.z) <= e.z);
}

// `v`: corners in shadow space. `sure`: out, whether the triangles can shade at all.
static inline ShadowTriangles set_up_shadow(const FV3* v, LaneLight light, float extent,
                                            MASK* sure) {
    ShadowTriangles out;
    ShadowPlanes p = shadow_planes(v, light);
    *sure = p.is_sure;
    MASK above = lane_mask(p.height > fv(0.0f));
    TwofoldVec3 seen[3];
    for (uint i = 0; i < 3; ++i) seen[i] = twofold_difference(v[i], light.at);
    // Towards a light's position normal and directions to points are opposite.
    FV side = lane_select(above, fv(1.0f), fv(-1.0f));
    FV inside = light.is_direction ? side : -side;
    for (uint i = 0; i < 3; ++i) {
        const uint j = (i + 1) % 3, k = (i + 2) % 3;
        ShadowForm f = light.is_direction
                           ? edge_form_along(v[j], v[k], light.at, extent, &out.unit[i])
                           : edge_form(seen[j], seen[k], &out.unit[i]);
        out.edge[i] = scale_form(f, inside / out.unit[i]);
    }
    FV by = -side / p.unit;
    out.plane.g = scale3(p.normal, by);
    out.plane.c = fma(-p.offset, by, fv(-2.0f));
    out.box = boxes_of(v);
    return out;
}

// The most that a form is in a box of its points.
static inline FV most_in_box(ShadowForm f, float3 low, float3 high) {
    return f.c + max(f.g.x * low.x, f.g.x * high.x) + max(f.g.y * low.y, f.g.y * high.y) +
           max(f.g.z * low.z, f.g.z * high.z);
}
#endif
