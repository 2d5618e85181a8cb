// SPDX-License-Identifier: Apache-2.0
// A light as shading reads it from global memory: a ShadeLight, or with HALF_LIGHT_COLORS one whose
// colour has half precision.
#ifndef KILOLUX_DEVICE_STORED_LIGHT_H
#define KILOLUX_DEVICE_STORED_LIGHT_H
#include "kernels/shared/light.h"

#ifndef HALF_LIGHT_COLORS
#define HALF_LIGHT_COLORS 0
#endif

#if HALF_LIGHT_COLORS
// Rows that the scene lacks are not stored.
#define STORED_0(text)
#define STORED_1(text) text
#define STORED_IF(has, text) STORED_##has(text)
// The colour is divided by a power of two, so that no intensity overflows. 32 bytes instead of 48
// without spot lights.
typedef struct StoredLight {
    float4 position_inv_range2;
    // xy: half4 of the colour / z; z: that power of two; w: 1/(cos_in - cos_out)
    uint4 color_scale;
#define STORED_ROW(has, feature, member) STORED_IF(has, float4 member;)
    LIGHT_ROWS(STORED_ROW)
} StoredLight;

static inline ShadeLight load_light(global const StoredLight* stored) {
    ShadeLight light;
    light.position_inv_range2 = stored->position_inv_range2;
    light.color_scale =
        vload_half4(0, (global const half*)&stored->color_scale) * as_float(stored->color_scale.z);
    light.color_scale.w = as_float(stored->color_scale.w);
#define LOAD_ROW(has, feature, member) STORED_IF(has, light.member = stored->member;)
    LIGHT_ROWS(LOAD_ROW)
    return light;
}

static inline void store_half_light(global StoredLight* stored, ShadeLight light) {
    float4 c = light.color_scale;
    float unit = ldexp(1.0f, clamp(ilogb(max(c.x, max(c.y, c.z))), -126, 126));
    stored->position_inv_range2 = light.position_inv_range2;
    stored->color_scale.zw = as_uint2((float2)(unit, c.w));
    vstore_half4_rte((float4)(c.xyz / unit, 0.0f), 0, (global half*)&stored->color_scale);
#define STORE_ROW(has, feature, member) STORED_IF(has, stored->member = light.member;)
    LIGHT_ROWS(STORE_ROW)
}
#define LIGHT_AT(lights, i) load_light((lights) + (i))
#else
#define StoredLight ShadeLight
// A macro: PoCL copies the light lane by lane if a function returns it.
#define LIGHT_AT(lights, i) (lights)[i]
#endif
#endif
