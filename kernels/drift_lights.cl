// SPDX-License-Identifier: Apache-2.0
// Lights that move by themselves: where they are, and the order in which kernels go through them,
// neighbours in space beside each other. Integers decide, so both are the same on every device.
//
//   drift_keys     a light's cell on a Morton curve, within cubes of 32 cells along an edge
//   drift_count    digits of a chunk's keys
//   (prefix_sum over digits and chunks)
//   drift_scatter  a chunk's keys to their places by digit: a stable radix sort, pass after pass
//   drift_permute  the lights' paths in that order: neighbours are read side by side every frame
//   drift_lights   the lights' rows
#include "kernels/shared/light.h"
#include "kernels/shared/light_drift.h"

#define DIGIT_BITS 8
#define DIGITS (1 << DIGIT_BITS)

static inline ulong of_halves(uint high, uint low) { return (ulong)high << 32 | low; }

// Time since the start.
typedef struct Elapsed {
    uint seconds;  // whole ones
    ulong rest;    // [2^-64 s]
} Elapsed;

// The share of a box's extent [2^-63] that a light is at. Whole turns are dropped.
static inline ulong reflected(ulong turns, ulong rate, Elapsed elapsed) {
    ulong speed = abs((long)rate);
    ulong moved = speed * elapsed.seconds + mul_hi(speed, elapsed.rest);
    turns = (long)rate < 0 ? turns - moved : turns + moved;
    return turns >> 63 ? 0ul - turns : turns;
}

// A light's shares of its box's extent.
typedef struct DriftShares {
    ulong x, y, z;
} DriftShares;

static inline DriftShares shares_at(LightDrift d, Elapsed elapsed) {
    DriftShares out;
    out.x =
        reflected(of_halves(d.high.x, d.low.x), of_halves(d.rate_high.x, d.rate_low.x), elapsed);
    out.y =
        reflected(of_halves(d.high.y, d.low.y), of_halves(d.rate_high.y, d.rate_low.y), elapsed);
    out.z =
        reflected(of_halves(d.high.z, d.low.z), of_halves(d.rate_high.z, d.rate_low.z), elapsed);
    return out;
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

// The cell that a share of 2^-63 of `cells` lies in.
static inline uint cell_at(ulong share, uint first, uint cells) {
    uint upper = (uint)min(share >> 31, (ulong)0xffffffffu);
    return first + mul_hi(upper, cells);
}

// The six lower bits, two zeros between each.
static inline uint spread(uint x) {
    x = x & 0x3fu;
    x = (x | x << 8) & 0x300fu;
    x = (x | x << 4) & 0x30c3u;
    return (x | x << 2) & 0x9249u;
}

static inline uint morton(uint x, uint y, uint z) {
    return spread(x) | spread(y) << 1 | spread(z) << 2;
}

static inline uint reversed(uint x) {
    x = (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
    x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
    x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
    x = (x & 0x00ff00ffu) << 8 | (x >> 8 & 0x00ff00ffu);
    return x << 16 | x >> 16;
}

// 18 bits of the cube, reversed, so that neighbouring cubes are far from each other: lights near
// the camera cost more than others, and consecutive ones are culled by one work-group. Then the
// cell in the cube but for its last bit.
static inline uint curve_key(uint x, uint y, uint z) {
    uint cube = morton(x >> 5, y >> 5, z >> 5);
    return (reversed(cube) & 0xffffc000u) | morton(x & 31u, y & 31u, z & 31u) >> 1;
}

kernel void drift_keys(global const LightDrift* restrict drifts,  // [count]
                       uint count, global const DriftBox* restrict boxes, uint seconds,
                       uint rest_high, uint rest_low,  // since the start: [s], [2^-64 s]
                       global uint2* restrict keys) {  // out [count]: key, light
    uint i = get_global_id(0);
    if (i >= count) return;
    LightDrift d = drifts[i];
    DriftBox box = boxes[d.high.w];
    DriftShares share = shares_at(d, (Elapsed){seconds, of_halves(rest_high, rest_low)});
    uint x = cell_at(share.x, box.first_cell.x, box.cells.x);
    uint y = cell_at(share.y, box.first_cell.y, box.cells.y);
    uint z = cell_at(share.z, box.first_cell.z, box.cells.z);
    keys[i] = (uint2)(curve_key(x, y, z), i);
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

kernel void drift_permute(global const uint16* restrict drifts,  // [count]: LightDrift
                          uint count, global const uint2* restrict order,
                          global uint16* restrict ordered) {  // out [count]
    uint i = get_global_id(0);
    if (i < count) ordered[i] = drifts[order[i].y];
}

kernel void drift_lights(global const LightDrift* restrict drifts,  // [count]
                         uint count, global const DriftBox* restrict boxes, uint seconds,
                         uint rest_high, uint rest_low,        // since the start: [s], [2^-64 s]
                         uint first,                           // row of the first light
                         global WorldLight* restrict world) {  // out: rows first .. first + count
    uint i = get_global_id(0);
    if (i >= count) return;
    LightDrift d = drifts[i];
    DriftBox box = boxes[d.high.w];
    DriftShares at = shares_at(d, (Elapsed){seconds, of_halves(rest_high, rest_low)});
    float2 x = place_in_box(at.x, box.min.x, box.min_low.x, box.extent.x, box.extent_low.x);
    float2 y = place_in_box(at.y, box.min.y, box.min_low.y, box.extent.y, box.extent_low.y);
    float2 z = place_in_box(at.z, box.min.z, box.min_low.z, box.extent.z, box.extent_low.z);
    WorldLight row;
    row.light.position_range = (float4)(x.x, y.x, z.x, box.min.w);
    row.light.color_scale =
        (float4)(as_float(d.low.w), as_float(d.rate_high.w), as_float(d.rate_low.w), 1.0f);
    row.light.axis_cos = (float4)(0.0f, 0.0f, 0.0f, -1.0f);  // a point light's cone
    row.position_low = (float4)(x.y, y.y, z.y, 0.0f);
    world[first + i] = row;
}
