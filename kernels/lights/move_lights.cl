// SPDX-License-Identifier: Apache-2.0
// Lights of the world -> camera-relative lights. Positions and camera are pairs of floats; their
// difference is that of doubles within 0.51 units in the last place, the same on every device: only
// sums, no products.
// One work-item moves one light.
#include "kernels/shared/light.h"

// a - b of pairs: the rounded difference of the high parts, and what it lost (Knuth's two-sum).
static inline float difference(float a, float a_low, float b, float b_low) {
    float s = a - b;
    float b_part = s - a;
    float lost = (a - (s - b_part)) - (b + b_part);
    return s + (lost + (a_low - b_low));
}

kernel void move_lights(global const WorldLight* restrict world,  // [count]
                        uint count, float4 eye_high, float4 eye_low,
                        global Light* restrict lights) {  // out [count]
    uint i = get_global_id(0);
    if (i >= count) return;
    Light light = world[i].light;
    float4 low = world[i].position_low;
    light.position_range.x = difference(light.position_range.x, low.x, eye_high.x, eye_low.x);
    light.position_range.y = difference(light.position_range.y, low.y, eye_high.y, eye_low.y);
    light.position_range.z = difference(light.position_range.z, low.z, eye_high.z, eye_low.z);
    lights[i] = light;
}
