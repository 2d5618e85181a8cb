// SPDX-License-Identifier: Apache-2.0
// A light as shading reads it from global memory: a ShadeLight, or with HALF_LIGHT_COLORS one whose
// colour has half precision.
#ifndef KILOLUX_DEVICE_STORED_LIGHT_H
#define KILOLUX_DEVICE_STORED_LIGHT_H
#include "kernels/shared/light.h"

#ifndef HALF_LIGHT_COLORS
#define HALF_LIGHT_COLORS 0
#endif
#ifndef HAS_SPOT_LIGHTS
#define HAS_SPOT_LIGHTS 0
#endif

#if HALF_LIGHT_COLORS
// The colour is divided by a power of two, so that no intensity overflows. 32 bytes instead of 48
// without spot lights.
typedef struct StoredLight {
    float4 position_inv_range2;
    // xy: half4 of the colour / z; z: that power of two; w: 1/(cos_in - cos_out)
    uint4 color_scale;
#if HAS_SPOT_LIGHTS
    float4 axis_cos;
#endif
} StoredLight;

static inline ShadeLight load_light(global const StoredLight* stored) {
    ShadeLight light;
    light.position_inv_range2 = stored->position_inv_range2;
    light.color_scale =
        vload_half4(0, (global const half*)&stored->color_scale) * as_float(stored->color_scale.z);
    light.color_scale.w = as_float(stored->color_scale.w);
#if HAS_SPOT_LIGHTS
    light.axis_cos = stored->axis_cos;
#endif
    return light;
}
#define LIGHT_AT(lights, i) load_light((lights) + (i))
#else
#define StoredLight ShadeLight
// A macro: PoCL copies the light lane by lane if a function returns it.
#define LIGHT_AT(lights, i) (lights)[i]
#endif
#endif
