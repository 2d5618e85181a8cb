// SPDX-License-Identifier: Apache-2.0
// The shaft from a light to a box of points, and which nodes' children it meets.
//
// For a light at o and points in [o + l, o + h] the shaft is their convex hull. It meets a child's
// box [L, H] exactly where some t in [0, 1] has t l <= H - o and t h >= L - o on all axes: each is
// an interval of t. For a light in the box [a, b] the same holds with t l <= H - a and t h >= L -
// b, l and h being the differences of the boxes' low and high ends. For a directional light the box
// itself moves along its direction: t d <= H - l and t d >= L - h, with t unbounded. The shaft is
// wider by SHADOW_PAD of its coordinates at both ends, which is more than what float32 and
// shadow_triangle.h's units need.
#ifndef KILOLUX_DEVICE_SHADOW_SHAFT_H
#define KILOLUX_DEVICE_SHADOW_SHAFT_H
#include "kernels/shadows/shadow_triangle.h"

typedef struct Shaft {
    float3 at_low, at_high;          // the origin of H and L
    float3 low, high;                // l and h, none of them 0
    float3 per_low, per_high;        // their reciprocals
    float most;                      // of t
    float3 points_low, points_high;  // box of the points [m]
    float3 x_low, x_high;            // box of the coordinates of edges' forms, before normalising
    float longest;                   // largest |x| + |y| + |z| of that box; 1 without normalising
} Shaft;

static inline float largest3(float3 v) { return fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z))); }

static inline float3 not_zero(float3 v) {
    return (float3)(fabs(v.x) < 1e-30f ? 1e-30f : v.x, fabs(v.y) < 1e-30f ? 1e-30f : v.y,
                    fabs(v.z) < 1e-30f ? 1e-30f : v.z);
}

// low, high: box of the points [m].
static inline Shaft make_shaft(ShadowLight light, float3 low, float3 high) {
    Shaft out;
    out.points_low = low;
    out.points_high = high;
    float size = fmax(largest3(low), largest3(high));
    if (light.is_direction) {
        float pad = fmax(size, 0.5f * light.reach) * (2.0f * SHADOW_PAD);
        out.at_low = low - pad;
        out.at_high = high + pad;
        out.low = not_zero(light.at - SHADOW_PAD);
        out.high = not_zero(light.at + SHADOW_PAD);
        out.most = SHADOW_NOWHERE;
        out.x_low = low;
        out.x_high = high;
        out.longest = 1.0f;
    } else {
        float3 light_low = light.at, light_high = light.at;
#if AREA_SHADOWS
        if (light.is_area) {
            light_low = light.area.low;
            light_high = light.area.high;
        }
#endif
        size = fmax(size, fmax(largest3(light_low), largest3(light_high)));
        float pad = size * (2.0f * SHADOW_PAD);
        out.at_low = light_low - pad;
        out.at_high = light_high + pad;
        out.x_low = low - light_low;
        out.x_high = high - light_high;
        out.low = not_zero(out.x_low - pad);
        out.high = not_zero(out.x_high + pad);
        out.most = 1.0f;
        float3 longest = fmax(fabs(out.x_low), fabs(out.x_high));
        out.longest = longest.x + longest.y + longest.z;
    }
    out.per_low = 1.0f / out.low;
    out.per_high = 1.0f / out.high;
    return out;
}

// Interval of t.
typedef struct ShaftSpan {
    FV first, last;
} ShaftSpan;

static inline ShaftSpan narrow(ShaftSpan span, FV t, bool from_below) {
    if (from_below) {
        span.first = max(span.first, t);
    } else {
        span.last = min(span.last, t);
    }
    return span;
}

// Children `first` .. `first` + VW - 1 of a node.
static inline MASK meets_children(Shaft s, global const ShadowNode* node, uint first) {
    ShaftSpan span = {fv(0.0f), fv(s.most)};
    span = narrow(span, (lane_load(node->high_x + first) - s.at_low.x) * s.per_low.x, s.low.x < 0);
    span =
        narrow(span, (lane_load(node->low_x + first) - s.at_high.x) * s.per_high.x, s.high.x > 0);
    span = narrow(span, (lane_load(node->high_y + first) - s.at_low.y) * s.per_low.y, s.low.y < 0);
    span =
        narrow(span, (lane_load(node->low_y + first) - s.at_high.y) * s.per_high.y, s.high.y > 0);
    span = narrow(span, (lane_load(node->high_z + first) - s.at_low.z) * s.per_low.z, s.low.z < 0);
    span =
        narrow(span, (lane_load(node->low_z + first) - s.at_high.z) * s.per_high.z, s.high.z > 0);
    return lane_mask(span.first <= span.last);
}

#if AREA_SHADOWS
// The same for rays to any points of the light: false only if the light and all points surely lie
// on one side of the triangle's plane. A hidden point is a unit behind it, 16 times the rounding
// here.
static inline MASK may_part(Shaft s, ShadowLight light, const FV3* v) {
    FV3 a = sub3(v[1], v[0]);
    FV3 b = sub3(v[2], v[0]);
    ShadowForm plane;
    plane.g = cross3(a, b);
    plane.c = -dot3(plane.g, v[0]);
    float ends = fmax(fmax(largest3(s.points_low), largest3(s.points_high)),
                      fmax(largest3(light.area.low), largest3(light.area.high)));
    FV unit = products3(a, b) * (size3(v[0]) + fv(3.0f * ends)) * (4.0f * SHADOW_UNIT);
    FV most = most_in_box(plane, s.points_low, s.points_high);
    FV most_light = most_in_box(plane, light.area.low, light.area.high);
    plane = scale_form(plane, fv(-1.0f));
    FV least = -most_in_box(plane, s.points_low, s.points_high);
    FV least_light = -most_in_box(plane, light.area.low, light.area.high);
    return (lane_mask(most_light >= -unit) & lane_mask(least <= fv(0.0f))) |
           (lane_mask(most >= fv(0.0f)) & lane_mask(least_light <= unit));
}
#endif

// Whether a triangle may shade a point of the shaft: false only if one of its forms is surely
// below -1 in all of its box.
static inline MASK may_shade(Shaft s, const ShadowTriangles* t) {
    MASK may = lane_mask(most_in_box(t->plane, s.points_low, s.points_high) >= fv(-2.0f));
    for (uint i = 0; i < 3; ++i) {
        may &= lane_mask(most_in_box(t->edge[i], s.x_low, s.x_high) >= fv(-2.0f * s.longest));
    }
    return may;
}
#endif
