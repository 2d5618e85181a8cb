// SPDX-License-Identifier: Apache-2.0
// Lights of the world -> camera-relative lights. Positions and camera are pairs of floats; their
// difference is that of doubles within 0.51 units in the last place, the same on every device: only
// sums, no products.
// One work-item moves one light.
//
//   drift_lights  lights that move by themselves, in the world
//   move_lights   all lights, relative to the camera
#include "kernels/shared/light.h"
#include "kernels/shared/light_drift.h"

// a - b of pairs: the rounded difference of the high parts, and what it lost (Knuth's two-sum).
static inline float difference(float a, float a_low, float b, float b_low) {
    float s = a - b;
    float b_part = s - a;
    float lost = (a - (s - b_part)) - (b + b_part);
    return s + (lost + (a_low - b_low));
}

static inline ulong of_halves(uint high, uint low) { return (ulong)high << 32 | low; }

// The share of a box's extent [2^-63] that a light is at, `elapsed` [2^-64 s] after the start.
static inline ulong reflected(ulong turns, ulong rate, ulong elapsed) {
    ulong moved = mul_hi(abs((long)rate), elapsed);
    turns = (long)rate < 0 ? turns - moved : turns + moved;
    return turns >> 63 ? 0ul - turns : turns;
}

// min + share * extent as a pair, within 2^-45 of |min| + extent.
static inline float2 place_in_box(ulong share, float min, float min_low, float extent,
                                  float extent_low) {
    float high = (float)(uint)(share >> 40) * 0x1p-23f;
    float low = (float)((uint)(share >> 16) & 0xffffffu) * 0x1p-47f;
    float product = high * extent;
    float rest = fma(high, extent_low, fma(low, extent, fma(high, extent, -product)));
    float s = min + product;
    float part = s - min;
    float lost = (min - (s - part)) + (product - part);
    lost += rest + min_low;
    float sum = s + lost;
    return (float2)(sum, lost - (sum - s));
}

kernel void drift_lights(global const LightDrift* restrict drifts,  // [count]
                         uint count, global const DriftBox* restrict boxes, uint elapsed_high,
                         uint elapsed_low,                     // [2^-64 s] since the start
                         global WorldLight* restrict world) {  // out: positions
    uint i = get_global_id(0);
    if (i >= count) return;
    LightDrift d = drifts[i];
    DriftBox box = boxes[d.low.w];
    ulong elapsed = of_halves(elapsed_high, elapsed_low);
    ulong x =
        reflected(of_halves(d.high.x, d.low.x), of_halves(d.rate_high.x, d.rate_low.x), elapsed);
    ulong y =
        reflected(of_halves(d.high.y, d.low.y), of_halves(d.rate_high.y, d.rate_low.y), elapsed);
    ulong z =
        reflected(of_halves(d.high.z, d.low.z), of_halves(d.rate_high.z, d.rate_low.z), elapsed);
    float2 px = place_in_box(x, box.min.x, box.min_low.x, box.extent.x, box.extent_low.x);
    float2 py = place_in_box(y, box.min.y, box.min_low.y, box.extent.y, box.extent_low.y);
    float2 pz = place_in_box(z, box.min.z, box.min_low.z, box.extent.z, box.extent_low.z);
    global WorldLight* out = world + d.high.w;
    out->light.position_range.xyz = (float3)(px.x, py.x, pz.x);
    out->position_low = (float4)(px.y, py.y, pz.y, 0.0f);
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
