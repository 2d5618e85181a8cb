// SPDX-License-Identifier: Apache-2.0
// Pixels and lights in shadow space.
#ifndef KILOLUX_DEVICE_SHADOW_SPACE_H
#define KILOLUX_DEVICE_SHADOW_SPACE_H
#include "kernels/device/lanes.h"
#include "kernels/lists/light_reach.h"
#include "kernels/shadows/area_target.h"
#include "kernels/shared/gbuffer.h"
#include "kernels/shared/shadow.h"

// Planes of the ends of every pixel's rays: position [m], and the normal of its triangle on the
// side that the eye sees, as packed_normal().
#define ORIGIN_X 0
#define ORIGIN_Y 1
#define ORIGIN_Z 2
#define ORIGIN_NORMAL 3
#define ORIGIN_PLANES 4

static inline float row_of_shadow(float4 row, float3 v) {
    return fma(row.z, v.z, fma(row.y, v.y, row.x * v.x));
}

// A direction from view space.
static inline float3 shadow_direction(ShadowView view, float3 v) {
    return (float3)(row_of_shadow(view.shadow_from_view[0], v),
                    row_of_shadow(view.shadow_from_view[1], v),
                    row_of_shadow(view.shadow_from_view[2], v));
}

// A point from view space [m].
static inline float3 shadow_point(ShadowView view, float3 p) {
    return shadow_direction(view, p) + (float3)(view.shadow_from_view[0].w,
                                                view.shadow_from_view[1].w,
                                                view.shadow_from_view[2].w);
}

// A vector or, with `w` 1, a point of each lane from view space.
static inline FV3 lane_shadow_point(ShadowView view, FV3 v, float w) {
    float4 x = view.shadow_from_view[0], y = view.shadow_from_view[1], z = view.shadow_from_view[2];
    return fv3(fma(fv(x.z), v.z, fma(fv(x.y), v.y, fma(fv(x.x), v.x, fv(x.w * w)))),
               fma(fv(y.z), v.z, fma(fv(y.y), v.y, fma(fv(y.x), v.x, fv(y.w * w)))),
               fma(fv(z.z), v.z, fma(fv(z.y), v.y, fma(fv(z.x), v.x, fv(z.w * w)))));
}

// A light as the target of rays: points have a position, directional ones a direction.
typedef struct ShadowLight {
    float3 at;  // position [m]; or the unit direction towards the light
    float inv_range2;
    float reach;  // no ray is longer [m]
    bool is_direction;
#if AREA_SHADOWS
    bool is_area;  // each point has a target of its own
    AreaLight area;
#endif
} ShadowLight;

// The same of VW rays.
typedef struct LaneLight {
    FV3 at;
    float reach;
    bool is_direction;
    float margin;  // so near to `at` a triangle's plane does not hide it [m]
} LaneLight;

static inline FV3 splat3(float3 v) { return fv3(fv(v.x), fv(v.y), fv(v.z)); }

// The light at the end of VW rays that have it in common.
static inline LaneLight shared_light(ShadowLight light) {
    float margin = 0.0f;
#if AREA_SHADOWS
    if (light.is_area) margin = light.area.margin;
#endif
    return (LaneLight){splat3(light.at), light.reach, light.is_direction, margin};
}

// `light`: in view space.
static inline ShadowLight shadow_point_light(ShadowView view, ShadeLight light) {
    float4 target = shadow_target(light);
    ShadowLight out;
    out.at = shadow_point(view, target.xyz);
    out.inv_range2 = target.w;
    out.reach = fmin(1.0f / sqrt(fmax(target.w, 1e-30f)), 2.0f * view.extent);
    out.is_direction = false;
#if AREA_SHADOWS
    out.is_area = false;
#endif
    return out;
}

#if AREA_SHADOWS
// The light with the shape that stands beside it. key: light_key() of the tile.
static inline ShadowLight with_shape(ShadowLight light, ShadowView view, float4 position,
                                     LightShape shape, uint key) {
    light.is_area = has_size(shape);
    light.area.shape = shape;
    light.area.center = position.xyz;
    light.area.of_light = key;
    if (!light.is_area) return light;
    box_of_area(view, light.at, &light.area);
    light.area.margin = area_margin(light.area);
    light.reach += length(light.area.high - light.area.low);
    return light;
}
#endif

static inline ShadowLight shadow_directional_light(ShadowView view, DirectionalLight light) {
    ShadowLight out;
    out.at = shadow_direction(view, light.to_light.xyz);
    out.inv_range2 = 0.0f;
    out.reach = 2.0f * view.extent;
    out.is_direction = true;
#if AREA_SHADOWS
    out.is_area = false;
#endif
    return out;
}

// A unit vector in a float's bits: octahedral, 16 bits a coordinate; and back.
static inline FV packed_normal(FV3 n) {
    FV3 p = octahedral_encode(n);
    UV x = lane_to_uint(fma(p.x, fv(32767.5f), fv(32768.0f)));
    UV y = lane_to_uint(fma(p.y, fv(32767.5f), fv(32768.0f)));
    return lane_from_bits(min(x, (UV)(65535u)) | min(y, (UV)(65535u)) << 16);
}

static inline FV3 unpacked_normal(FV packed) {
    UV code = lane_bits(packed);
    return octahedral_decode(fma(lane_to_float(code & 0xffffu), fv(2.0f / 65535.0f), fv(-1.0f)),
                             fma(lane_to_float(code >> 16), fv(2.0f / 65535.0f), fv(-1.0f)));
}
#endif
