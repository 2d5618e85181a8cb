// SPDX-License-Identifier: Apache-2.0
// Lights with their colours in half precision, for shading with HALF_LIGHT_COLORS.
// One work-item stores one light.
#include "kernels/device/stored_light.h"

kernel void store_lights(global const ShadeLight* restrict lights,  // [light_count]
                         global StoredLight* restrict stored) {     // out [light_count]
    uint i = get_global_id(0);
    store_half_light(stored + i, lights[i]);
}
