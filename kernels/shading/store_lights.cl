// SPDX-License-Identifier: Apache-2.0
// Lights with their colours in half precision, for shading with HALF_LIGHT_COLORS.
// One work-item stores one light.
#include "kernels/device/stored_light.h"

kernel void store_lights(global const ShadeLight* restrict lights,  // [light_count]
                         global StoredLight* restrict stored) {     // out [light_count]
    uint i = get_global_id(0);
    float4 c = lights[i].color_scale;
    float unit = ldexp(1.0f, clamp(ilogb(max(c.x, max(c.y, c.z))), -126, 126));
    stored[i].position_inv_range2 = lights[i].position_inv_range2;
    stored[i].color_scale.zw = as_uint2((float2)(unit, c.w));
    vstore_half4_rte((float4)(c.xyz / unit, 0.0f), 0, (global half*)&stored[i].color_scale);
#if HAS_SPOT_LIGHTS
    stored[i].axis_cos = lights[i].axis_cos;
#endif
}
