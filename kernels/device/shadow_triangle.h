// SPDX-License-Identifier: Apache-2.0
// Which triangles stand between a light and points: VW triangles set up at once as affine forms,
// which then any number of points evaluates.
//
// Seen from the light a point lies within a triangle's edges where u_i >= 0 for all i; u_i is the
// product of an edge's plane through the light, v_j x v_k, with the direction to the point. It
// shades the point where, too, the triangle's plane has the light on one side and the point on the
// other. Rays of one light have their origin in common, so all four are affine in the point.
//
// Each form is divided by a bound of what rounding does to it (16 * 2^-24 of the products that it
// sums, of which fewer than 10 round), so its sign is sure beyond +-1:
// * edges grant 1 unit: a ray along the common edge or vertex of triangles never slips between
//   them. They are wider by less than 2^-17 of the distance from the light.
// * the plane asks for 1 unit: a triangle never shades its own points, nor those of its neighbours
//   in the plane. Points that lie less than the unit behind it, 2^-17 of the coordinates, are lit.
// A light so near to a triangle's plane that its side is unsure is not shaded by it. So whether a
// triangle shades a point depends on the light, the triangle and the point alone, and not on which
// walk found it.
#ifndef KILOLUX_DEVICE_SHADOW_TRIANGLE_H
#define KILOLUX_DEVICE_SHADOW_TRIANGLE_H
#include "kernels/device/shadow_space.h"

#define SHADOW_UNIT (1.0f / (1 << 20))

// u = g . x + c: of an edge x is the direction to the point, |x| + |y| + |z| = 1, or, of a
// directional light, the point; of the plane it is the point.
typedef struct ShadowForm {
    FV3 g;
    FV c;
} ShadowForm;

// Shades where edge[0..2] and plane are all at least -1.
typedef struct ShadowTriangles {
    ShadowForm edge[3];
    ShadowForm plane;
    FV unit[3];  // of the edges
} ShadowTriangles;

static inline FV size3(FV3 v) { return fabs(v.x) + fabs(v.y) + fabs(v.z); }

static inline FV3 splat3(float3 v) { return fv3(fv(v.x), fv(v.y), fv(v.z)); }

// The sum of the magnitudes of the products in a x b.
static inline FV products3(FV3 a, FV3 b) {
    return (fabs(a.y * b.z) + fabs(a.z * b.y)) + (fabs(a.z * b.x) + fabs(a.x * b.z)) +
           (fabs(a.x * b.y) + fabs(a.y * b.x));
}

// The plane through edge a -> b and a light: at 0, or in the direction `towards`. Exactly minus
// that of b -> a.
static inline ShadowForm edge_form(FV3 a, FV3 b, ShadowLight light, float extent, FV* unit) {
    ShadowForm out;
    FV3 s = add3(a, b);
    FV3 d = sub3(b, a);
    if (light.is_direction) {
        FV3 l = splat3(light.at);
        FV3 g = cross3(d, l);
        FV size = fma(fv(0.5f), size3(s), fv(extent));
        *unit = max(products3(d, l) * size * SHADOW_UNIT, fv(1e-36f));
        out.c = 0.5f * dot3(s, g);
        out.g = scale3(g, fv(-1.0f));
    } else {
        out.g = cross3(s, d);
        out.c = fv(0.0f);
        *unit = max(products3(s, d) * SHADOW_UNIT, fv(1e-36f));
    }
    return out;
}

static inline ShadowForm scale_form(ShadowForm f, FV by) {
    f.g = scale3(f.g, by);
    f.c *= by;
    return f;
}

// The triangles' corners turned so that the longest edge is opposite to the first: the shorter two
// lose least in their product.
static inline void turn_corners(FV3* v) {
    FV opposite[3];
    for (uint i = 0; i < 3; ++i) opposite[i] = size3(sub3(v[(i + 2) % 3], v[(i + 1) % 3]));
    MASK second = lane_mask(opposite[1] > opposite[0]) & lane_mask(opposite[1] >= opposite[2]);
    MASK third = lane_mask(opposite[2] > opposite[0]) & lane_mask(opposite[2] > opposite[1]);
    FV3 turned[3];
    for (uint i = 0; i < 3; ++i) {
        turned[i] = select3(second, v[(i + 1) % 3], select3(third, v[(i + 2) % 3], v[i]));
    }
    for (uint i = 0; i < 3; ++i) v[i] = turned[i];
}

// The triangles' planes and how high the light is above them.
typedef struct ShadowPlanes {
    FV3 normal;    // (v1 - v0) x (v2 - v0), v turned
    FV offset;     // normal . v0
    FV unit;       // of normal . p - offset
    FV height;     // the light's, times the normal's length
    MASK is_sure;  // of the height's sign
} ShadowPlanes;

// `v`: corners in shadow space.
static inline ShadowPlanes shadow_planes(const FV3* v, ShadowLight light) {
    FV3 t[3] = {v[0], v[1], v[2]};
    turn_corners(t);
    FV3 a = sub3(t[1], t[0]);
    FV3 b = sub3(t[2], t[0]);
    FV products = products3(a, b);
    FV size = max(max(size3(t[0]), size3(t[1])), size3(t[2]));
    ShadowPlanes out;
    out.normal = cross3(a, b);
    out.offset = dot3(out.normal, t[0]);
    out.unit = max(products * (size + light.reach) * SHADOW_UNIT, fv(1e-36f));
    FV3 l = splat3(light.at);
    FV height_unit = products * SHADOW_UNIT;
    if (light.is_direction) {
        out.height = dot3(out.normal, l);
    } else {
        FV3 from = sub3(l, t[0]);
        out.height = dot3(out.normal, from);
        height_unit *= size3(from);
    }
    out.is_sure = lane_mask(fabs(out.height) > max(height_unit, fv(1e-36f)));
    return out;
}

// `v`: corners in shadow space. `sure`: out, whether the triangles can shade at all.
static inline ShadowTriangles set_up_shadow(const FV3* v, ShadowLight light, float extent,
                                            MASK* sure) {
    ShadowTriangles out;
    ShadowPlanes p = shadow_planes(v, light);
    *sure = p.is_sure;
    MASK above = lane_mask(p.height > fv(0.0f));
    FV3 seen[3] = {v[0], v[1], v[2]};
    if (!light.is_direction) {
        for (uint i = 0; i < 3; ++i) seen[i] = sub3(v[i], splat3(light.at));
    }
    // Towards a light's position normal and directions to points are opposite.
    FV side = lane_select(above, fv(1.0f), fv(-1.0f));
    FV inside = light.is_direction ? side : -side;
    for (uint i = 0; i < 3; ++i) {
        ShadowForm f = edge_form(seen[(i + 1) % 3], seen[(i + 2) % 3], light, extent, &out.unit[i]);
        out.edge[i] = scale_form(f, inside / out.unit[i]);
    }
    FV by = -side / p.unit;
    out.plane.g = scale3(p.normal, by);
    out.plane.c = fma(-p.offset, by, fv(-2.0f));
    return out;
}

// The most that a form is in a box of its points.
static inline FV most_in_box(ShadowForm f, float3 low, float3 high) {
    return f.c + max(f.g.x * low.x, f.g.x * high.x) + max(f.g.y * low.y, f.g.y * high.y) +
           max(f.g.z * low.z, f.g.z * high.z);
}
#endif
