// SPDX-License-Identifier: Apache-2.0
// Generated lights that move: their places, and the order in which kernels go through them,
// neighbours in space beside each other. Integers decide, so both are the same on every device.
//
//   drift_keys     a light's place in the order (light_order.h)
//   drift_count    digits of a chunk's keys
//   (prefix_sum over digits and chunks)
//   drift_scatter  a chunk's keys to their places by digit: a stable radix sort, pass after pass
//   drift_paths    the lights' paths in that order: neighbours are read side by side every frame
//   drift_lights   the lights' rows
#include "kernels/shared/light.h"
#include "kernels/shared/lights/light_drift.h"
#include "kernels/shared/lights/light_order.h"

#define DIGIT_BITS 8
#define DIGITS (1 << DIGIT_BITS)

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

// The cell that a pair of floats lies in, in cells.
static inline uint cell_at(float2 place, float cells_per_metre) {
    float cell = place.x * cells_per_metre;
    float whole = floor(cell);
    float rest = (cell - whole) + place.y * cells_per_metre;
    if (!(fabs(cell) < LIGHT_CELLS)) return LIGHT_CELL_FAR;
    return (uint)((int)whole + (int)floor(rest));
}

// The place of a light.
typedef struct DriftPlace {
    float2 x, y, z;  // pairs of floats [m]
} DriftPlace;

static inline DriftPlace place_at(LightDrift d, DriftBox box, DriftTime time) {
    DriftPlace out;
    out.x = place_in_box(DRIFT_SHARE(d, x, time), box.min.x, box.min_low.x, box.extent.x,
                         box.extent_low.x);
    out.y = place_in_box(DRIFT_SHARE(d, y, time), box.min.y, box.min_low.y, box.extent.y,
                         box.extent_low.y);
    out.z = place_in_box(DRIFT_SHARE(d, z, time), box.min.z, box.min_low.z, box.extent.z,
                         box.extent_low.z);
    return out;
}

kernel void drift_keys(global const LightSwarm* restrict swarm, uint count, DriftTime time,
                       global uint2* restrict keys) {  // out [count]: key, light
    uint i = get_global_id(0);
    if (i >= count) return;
    LightDrift d = swarm_light(swarm, i);
    DriftBox box = swarm->boxes[d.high.w];
    DriftPlace p = place_at(d, box, time);
    float scale = box.extent.w;
    uint key = light_order_key(cell_at(p.x, scale), cell_at(p.y, scale), cell_at(p.z, scale));
    keys[i] = (uint2)(key, i);
}

// The first light of a chunk; that of the next is its end.
static inline uint chunk_start(uint count, uint chunk, uint chunks) {
    return (uint)((ulong)count * chunk / chunks);
}

static inline uint digit_of(uint2 key, uint shift) { return key.x >> shift & (DIGITS - 1u); }

kernel void drift_count(global const uint2* restrict keys,  // [count]
                        uint count, uint chunks, uint shift,
                        global uint* restrict counts) {  // out [DIGITS][chunks]
    uint chunk = get_global_id(0);
    if (chunk >= chunks) return;
    uint mine[DIGITS];
    for (uint i = 0; i < DIGITS; ++i) mine[i] = 0u;
    uint end = chunk_start(count, chunk + 1u, chunks);
    for (uint i = chunk_start(count, chunk, chunks); i < end; ++i) {
        ++mine[digit_of(keys[i], shift)];
    }
    for (uint i = 0; i < DIGITS; ++i) counts[i * chunks + chunk] = mine[i];
}

kernel void drift_scatter(global const uint2* restrict keys,  // [count]
                          uint count, uint chunks, uint shift,
                          global const uint* restrict offsets,  // [DIGITS][chunks]
                          global uint2* restrict sorted) {      // out [count]
    uint chunk = get_global_id(0);
    if (chunk >= chunks) return;
    uint next[DIGITS];
    for (uint i = 0; i < DIGITS; ++i) next[i] = offsets[i * chunks + chunk];
    uint end = chunk_start(count, chunk + 1u, chunks);
    for (uint i = chunk_start(count, chunk, chunks); i < end; ++i) {
        uint2 key = keys[i];
        sorted[next[digit_of(key, shift)]++] = key;
    }
}

kernel void drift_paths(global const LightSwarm* restrict swarm, uint count,
                        global const uint2* restrict order,    // [count]: key, light
                        global LightDrift* restrict drifts) {  // out [count], in that order
    uint i = get_global_id(0);
    if (i < count) drifts[i] = swarm_light(swarm, order[i].y);
}

kernel void drift_lights(global const LightSwarm* restrict swarm, uint count,
                         global const LightDrift* restrict drifts,  // [count]
                         DriftTime time,
                         uint first,                           // row of the first light
                         global WorldLight* restrict world) {  // out: rows first .. first + count
    uint i = get_global_id(0);
    if (i >= count) return;
    LightDrift d = drifts[i];
    DriftBox box = swarm->boxes[d.high.w];
    DriftPlace p = place_at(d, box, time);
    WorldLight row;
    row.light =
        point_light_rows((float4)(p.x.x, p.y.x, p.z.x, box.min.w), drift_intensity(swarm, d));
    row.position_low = (float4)(p.x.y, p.y.y, p.z.y, 0.0f);
    world[first + i] = row;
}
