// SPDX-License-Identifier: Apache-2.0
// Which pixels a triangle covers, and how near it is there.
//
// Coverage. With the vertices v_i as the eye sees them and the ray d of a pixel, u_i = (v_j x v_k)
// . d, cyclic, have one sign where the line along d meets the triangle, and that sign is that of
// det(v_0, v_1, v_2) where it does so in front of the eye. Nothing is clipped and nothing divided.
// u_i as a float errs by less than 10 * 2^-24 of the products that it sums; a scaled edge has 16 *
// 2^-24 of them as its unit, so its sign is certain beyond +-1. Within, exact_sign.h decides. So
// every pixel's answer is exact: each pixel that a closed surface covers belongs to one triangle of
// each of its layers, and all devices, lane widths and tiles agree.
//
// Depth. Keys grow towards the eye: 1/z, for parallel rays -z. They are affine in the pixel, as the
// plane's equation, bounded by those of the vertices, and the same bits everywhere: sums, products,
// and lane_reciprocal().
#ifndef KILOLUX_DEVICE_RASTER_TRIANGLE_H
#define KILOLUX_DEVICE_RASTER_TRIANGLE_H
#include "kernels/device/triangle.h"
#include "kernels/surfaces/exact_sign.h"

// 2^-20 is 16 * 2^-24; 2^-36 bounds the parts that exact_sign.h cuts off.
#define SURE_SHARE (1.0f / (1 << 20))
#define CUT_SHARE (1.0f / (1 << 18) / (1 << 18))

// In parallel views the eye sees every vertex at depth 1.
static inline FV3 seen_vertex(View view, FV3 v) {
    if (view.orthographic != 0u) v.z = fv(-1.0f);
    return v;
}

// The y of the rays of a row of the planes, and of VW rows; the x of those of VW columns. Planes
// that triangles are drawn to hold one layer.
static inline float ray_y(View view, uint y) {
    return fma((float)(y + view.first_row) + 0.5f, view.ray.z, view.ray.w);
}
static inline FV rays_y(View view, UV y) {
    return fma(lane_to_float(y + view.first_row) + 0.5f, fv(view.ray.z), fv(view.ray.w));
}
static inline FV ray_x(View view, UV x) {
    return fma(lane_to_float(x + view.first_column) + 0.5f, fv(view.ray.x), fv(view.ray.y));
}

// A triangle's vertices as the eye sees them, and the sign of its determinant, in integers.
typedef struct ExactTriangle {
    Fixed3 a, b, c;
    int side;
} ExactTriangle;

// `number`: along the instances.
static inline ExactTriangle exact_triangle(SurfaceScene scene, View view, uint number) {
    Triangle t = fetch_triangle(scene, number + 1u);
    float3 seen[3];
    for (uint i = 0; i < 3; ++i) {
        seen[i] = view_vertex(t.instance, vertex_float3(t.vertex[i], 0u));
        if (view.orthographic != 0u) seen[i].z = -1.0f;
    }
    ExactTriangle out;
    out.a = fixed_of(seen[0]);
    out.b = fixed_of(seen[1]);
    out.c = fixed_of(seen[2]);
    out.side = sign_along(wide_cross(out.a, out.b), out.c);
    return out;
}

static inline bool covers_exactly(const ExactTriangle* t, float2 ray) {
    Fixed3 d = fixed_of((float3)(ray, -1.0f));
    return edge_side(t->b, t->c, d) == t->side && edge_side(t->c, t->a, d) == t->side &&
           edge_side(t->a, t->b, d) == t->side;
}

// Keys at the far plane of the rays through pixels; at the near plane they are larger by
// near_from_far().
static inline FV far_key(View view, FV px, FV py) {
    FV q = fma(px, fv(view.depth.y), fma(py, fv(view.depth.z), fv(view.depth.w)));
    return view.orthographic != 0u ? -q : q;
}
static inline float near_from_far(View view) {
    return view.orthographic != 0u ? -view.depth.x : view.depth.x;
}

// No pixel's key at the near plane is smaller.
static inline float least_near_key(View view) {
    float across = view.depth.y * (float)(view.first_column + view.width);
    float down = view.depth.z * (float)(view.first_row + view.height);
    float slack = SURE_SHARE * (fabs(across) + fabs(down) + fabs(view.depth.w));
    float q = view.orthographic != 0u ? -(view.depth.w + fmax(across, 0.0f) + fmax(down, 0.0f))
                                      : view.depth.w + fmin(across, 0.0f) + fmin(down, 0.0f);
    return q + near_from_far(view) - slack;
}
#endif
