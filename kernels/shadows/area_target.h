// SPDX-License-Identifier: Apache-2.0
// Where sampled shadow rays to lights with a size go: each pixel has points of its own for each of
// a light's slots.
#ifndef KILOLUX_DEVICE_AREA_TARGET_H
#define KILOLUX_DEVICE_AREA_TARGET_H
#include "kernels/lists/light_reach.h"
#include "kernels/shadows/shadow_random.h"
#include "kernels/shared/area/sample_shape.h"
#include "kernels/shared/light_extras.h"
#include "kernels/shared/shadow.h"

// Whether rays go to such lights.
#ifndef AREA_SHADOWS
#define AREA_SHADOWS 0
#endif

// Most points that are drawn for one ray until one is kept. Of a light that is wholly above the
// horizon a quarter or more are kept: after 64 none is left in 1e-8 of the cases. Where the horizon
// leaves little of a light, the last point above it is taken, else about the highest one.
#define AREA_ATTEMPTS 64u

// A light as the target of rays.
typedef struct AreaLight {
    LightShape shape;  // view space; SHAPE_POINT: the light has no size
    float3 center;     // view space [m]
    uint key;          // light_key() of the seed, tile and light
    uint slot;
    float3 low, high;  // box of its targets, shadow space [m]
} AreaLight;

// Pixels as rays to lights with a size begin there.
typedef struct AreaOrigins {
    FV3 position, normal;  // of the surface, view space
    UV key;                // pixel_key()
} AreaOrigins;

// Largest distances of the shape's points from its centre along three axes that `row` turns it
// to [m].
static inline float reach_along(LightShape shape, float4 row) {
    float x = fabs(dot(row.xyz, shape.half_x.xyz));
    float y = fabs(dot(row.xyz, shape.half_y.xyz));
    return shape_kind(shape) == SHAPE_SPHERE ? length(shape.half_x.xyz) : x + y;
}

// The box of the whole light, with more than targets' rounding.
static inline void box_of_area(ShadowView view, float3 center, AreaLight* light) {
    float4 x = view.shadow_from_view[0], y = view.shadow_from_view[1], z = view.shadow_from_view[2];
    LightShape shape = light->shape;
    float3 reach =
        (float3)(reach_along(shape, x), reach_along(shape, y), reach_along(shape, z)) * 1.001f;
    light->low = center - reach;
    light->high = center + reach;
}

// The vectors from the origins to the targets of the light's slot, view space [m]; where not
// `wanted` they are undefined.
static inline FV3 area_targets(AreaLight light, AreaOrigins from, MASK wanted) {
    FV3 p = from.position;
    FV3 center = fv3(fv(light.center.x) - p.x, fv(light.center.y) - p.y, fv(light.center.z) - p.z);
    const SeenShape seen = see_shape(light.shape, center, from.normal);
    FV3 out = seen.highest;
    MASK left = wanted;
    for (uint attempt = 0; attempt < AREA_ATTEMPTS && lane_any(left); ++attempt) {
        LaneFractions random = ray_fractions(light.key, from.key, light.slot, attempt);
        ShapeSample s = sample_shape(&seen, lane_random_of(random.u), lane_random_of(random.v));
        out = select3(left & lane_mask(s.share > fv(0.0f)), s.to_light, out);
        left &= lane_mask(s.share <= lane_random_of(random.w));
    }
    return out;
}
#endif
