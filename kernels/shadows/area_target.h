// SPDX-License-Identifier: Apache-2.0
// Where sampled shadow rays to lights with a size go: each pixel has points of its own for each of
// a light's slots.
#ifndef KILOLUX_DEVICE_AREA_TARGET_H
#define KILOLUX_DEVICE_AREA_TARGET_H
#include "kernels/lists/light_reach.h"
#include "kernels/shadows/shadow_bits.h"
#include "kernels/shadows/shadow_random.h"
#include "kernels/shared/area/sample_shape.h"
#include "kernels/shared/evaluate.h"
#include "kernels/shared/light_extras.h"
#include "kernels/shared/shadow.h"

// Whether rays go to such lights.
#ifndef AREA_SHADOWS
#define AREA_SHADOWS 0
#endif

#if AREA_SHADOWS
// Most points that are drawn for one ray until one is kept. Of most lights above the horizon a
// quarter or more are kept: then 64 find none in 1e-8 of the cases. Of a long thin strip at a low
// angle 8 % may be kept: then 64 find none in 0.5 %. There, and where the horizon leaves little of
// a light, the last point above the horizon is taken, else about the highest one.
#define AREA_ATTEMPTS 64u

// A light as the target of rays.
typedef struct AreaLight {
    LightShape shape;  // view space; SHAPE_POINT: the light has no size
    float3 center;     // view space [m]
    uint of_light;     // light_key() of the seed, tile and light
    uint key;          // lobe_key() of that
    uint lobe;
    UV slot;           // of the lobe, of each lane's ray
    float3 low, high;  // box of its targets, shadow space [m]
    float margin;      // area_margin()
} AreaLight;

// The light as the target of rays whose slots are of one lobe, that of lane 0. slots: of the light.
static inline AreaLight at_slots(AreaLight light, uint lobe, UV slots, float rays) {
    light.lobe = lobe;
    light.slot = slots - (UV)(lobe * lobe_slots(rays));
    light.key = lobe_key(light.of_light, lobe);
    return light;
}

static inline AreaLight at_slot(AreaLight light, uint slot, float rays) {
    return at_slots(light, slot / lobe_slots(rays), (UV)(slot), rays);
}

// Pixels as rays to lights with a size begin there.
typedef struct AreaOrigins {
    FV3 position, normal;  // of the surface, view space
    UV key;                // pixel_key()
#if AREA_LOBES > 1u
    FV3 gloss_x,
        gloss_y;  // to the space where the glossy lobe is a cosine about z, rows of x and y
#endif
} AreaOrigins;

static inline AreaOrigins area_origins(ShadingPoint p, Pixels pixels) {
    AreaOrigins out;
    out.position = p.position;
    out.normal = p.normal;
    out.key = pixel_key(pixels);
#if AREA_LOBES > 1u
    // The transform of the frame's axes.
    FV zero = fv(0.0f), one = fv(1.0f);
    FV3 x = transformed(p.area, fv3(one, zero, zero));
    FV3 y = transformed(p.area, fv3(zero, one, zero));
    FV3 z = transformed(p.area, fv3(zero, zero, one));
    out.gloss_x = add_along(add_along(scale3(p.frame.x, x.x), p.frame.y, y.x), p.frame.z, z.x);
    out.gloss_y = add_along(add_along(scale3(p.frame.x, x.y), p.frame.y, y.y), p.frame.z, z.y);
#endif
    return out;
}

#if AREA_LOBES > 1u
// To the space of the glossy lobe, and back.
static inline FV3 to_gloss(AreaOrigins of, FV3 v) {
    return fv3(dot3(of.gloss_x, v), dot3(of.gloss_y, v), dot3(of.normal, v));
}

static inline FV3 from_gloss(AreaOrigins of, FV3 q) {
    FV3 yz = cross3(of.gloss_y, of.normal), zx = cross3(of.normal, of.gloss_x);
    FV3 xy = cross3(of.gloss_x, of.gloss_y);
    FV3 v = add_along(add_along(scale3(yz, q.x), zx, q.y), xy, q.z);
    return scale3(v, fv(1.0f) / dot3(of.gloss_x, yz));
}
#endif

// A bound of the shape's extent from its centre along an axis [m]; `row`: the axis in view space.
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

// No target is farther from the light's own surface by rounding [m]. A target sums about ten
// roundings of coordinates in view space, and is turned to shadow space, where the corners of the
// triangles that the light may be made of are rounded, too: fewer than 16 of 2^-24 of each. Twice
// that, so that a triangle in the light's plane never hides it.
#define AREA_MARGIN (1.0f / (1 << 19))
static inline float area_margin(AreaLight light) {
    float3 farthest = fabs(light.center) + fmax(fabs(light.low), fabs(light.high));
    return AREA_MARGIN * (farthest.x + farthest.y + farthest.z);
}

// The light as the surface sees it; for the glossy lobe, in its space.
static inline SampledShape seen_by_lobe(AreaLight light, AreaOrigins from) {
    FV3 p = from.position;
    FV3 center = fv3(fv(light.center.x) - p.x, fv(light.center.y) - p.y, fv(light.center.z) - p.z);
#if AREA_LOBES > 1u
    if (light.lobe != 0u) {
        FramedLight seen = seen_light(center, light.shape);
        uint kind = seen.kind == SHAPE_SPHERE ? SHAPE_DISK : seen.kind;
        return see_shape(kind, to_gloss(from, seen.at.center), to_gloss(from, seen.at.half_x),
                         to_gloss(from, seen.at.half_y), fv3(fv(0.0f), fv(0.0f), fv(1.0f)));
    }
#endif
    return see_shape(shape_kind(light.shape), center, lanes3(light.shape.half_x),
                     lanes3(light.shape.half_y), from.normal);
}

#if AREA_LOBES > 1u
// Where rays to `target` meet a light that is a sphere: what it encloses, as a bulb, hides nothing
// of it. `target` is on the disk that the glossy lobe takes for the sphere.
static inline FV3 front_of_sphere(AreaLight light, AreaOrigins from, FV3 target) {
    SampledShape sphere;
    sphere.center = sub3(lanes3((float4)(light.center, 0.0f)), from.position);
    sphere.half_x = lanes3(light.shape.half_x);
    return sphere_point(&sphere, unit_direction(target));
}
#endif

// The vectors from the origins to the targets of the light's slot, view space [m]; where not
// `wanted` they are undefined.
static inline FV3 area_targets(AreaLight light, AreaOrigins from, MASK wanted) {
    const SampledShape seen = seen_by_lobe(light, from);
    FV3 out = seen.highest;
    MASK left = wanted;
    for (uint attempt = 0; attempt < AREA_ATTEMPTS && lane_any(left); ++attempt) {
        LaneFractions random = ray_fractions(light.key, from.key, light.slot, attempt);
        ShapeSample s = sample_shape(&seen, lane_random_of(random.u), lane_random_of(random.v));
        out = select3(left & lane_mask(s.share > fv(0.0f)), s.to_light, out);
        left &= lane_mask(s.share <= lane_random_of(random.w));
    }
#if AREA_LOBES > 1u
    if (light.lobe != 0u) {
        out = from_gloss(from, out);
        if (shape_kind(light.shape) == SHAPE_SPHERE) out = front_of_sphere(light, from, out);
    }
#endif
    return out;
}
#endif
#endif
