// SPDX-License-Identifier: Apache-2.0
// Where a light reaches, and where its shadow rays go. Only this header decides which points a
// light reaches. A kind that does not fill the sphere of its range, or has a size, has its case
// here. Lists ask cone_reaches() only where the scene has SceneFeatures::spot_lights.
#ifndef KILOLUX_DEVICE_LIGHT_REACH_H
#define KILOLUX_DEVICE_LIGHT_REACH_H
#include "kernels/shared/cluster_grid.h"
#include "kernels/shared/lights/light_transform.h"

// xyz: the point of a light that its shadow rays go to, view space [m]; w: 1 / d^2 [1/m^2] of the
// largest distance d from there to a point in the light's range.
static inline float4 shadow_target(ShadeLight light) {
    return (float4)(light.position_inv_range2.xyz, inv_range2_of(light));
}

// Distance from c to the interval [lo, hi]; 0 inside. Rounding is monotone, so the result is at
// most the distance to any point of the interval computed the same way.
static inline float interval_distance(float c, float lo, float hi) {
    return max(max(lo - c, c - hi), 0.0f);
}

// Does a light reach a box? This and cone_reaches() are the one test of culling, refinement and the
// brute-force oracle. The sphere of (x, y, z, 1/range^2) against a box, from the distances by axis
// (Arvo, Graphics Gems I, p. 335). The sum is associated as in evaluate(), so that a box is never
// farther than its pixels.
static inline bool sphere_reaches(float dx, float dy, float dz, float inv_range2) {
    return fma(dz, dz, fma(dy, dy, dx * dx)) * inv_range2 <= CULL_LIMIT;
}

// A spot's cone against a box: false only if no point of the box is inside. The corners decide
// whether the box is behind the apex, so that the half-space before a flat light is tested exactly.
// Else the box's bounding sphere is tested by the distance from its centre to the cone's surface.
// The nearest point of that surface lies on it wherever the centre is outside: of cones narrower
// than 90 degrees that holds in front of their apex, of wider ones everywhere.
static inline bool cone_reaches(ShadeLight light, float3 lo, float3 hi) {
    float3 q = 0.5f * (lo + hi) - light.position_inv_range2.xyz;
    float3 half_size = 0.5f * (hi - lo);
    float radius = length(half_size);
    float q2 = dot(q, q);
    // Point lights, and squares beyond float32's range, leave the decision to the box test.
    if (!(q2 + radius * radius < 1e30f) || light.axis_cos.w <= -1.0f) return true;
    float along = dot(q, light.axis_cos.xyz);
    float across = sqrt(max(q2 - along * along, 0.0f));
    float cos_out = light.axis_cos.w;
    float sin_out = sqrt(max(1.0f - cos_out * cos_out, 0.0f));
    float slack = 1e-3f * (radius + sqrt(q2));  // more than float32 loses here
    // The corner farthest along the axis; 1e-5: more than the dot products lose.
    float corner = fma(1e-5f, radius + sqrt(q2), dot(half_size, fabs(light.axis_cos.xyz)));
    // A selection, not a branch: PoCL 3.1 loses values across cull_lights' barriers otherwise.
    float back = cos_out < 0.0f ? -1e30f : -corner;
    return cos_out * across - sin_out * along <= radius + slack && along >= back;
}
#endif
