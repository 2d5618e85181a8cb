// SPDX-License-Identifier: Apache-2.0
// Generated lights that move. Integers decide where each is at any time, so it is the same on every
// device. For OpenCL C and C++.
#ifndef KILOLUX_SHARED_LIGHTS_LIGHT_DRIFT_H
#define KILOLUX_SHARED_LIGHTS_LIGHT_DRIFT_H
#include "kernels/shared/hash.h"
#include "kernels/shared/types.h"

#define SWARM_BOXES 6

#if defined(__cplusplus)
#define SWARM_POINTER const LightSwarm*
namespace kilolux {
// The upper half of the product, as in OpenCL C.
inline ulong mul_hi(ulong a, ulong b) {
    __extension__ using Product = unsigned __int128;
    return static_cast<ulong>((static_cast<Product>(a) * b) >> 64);
}
#else
#define SWARM_POINTER global const LightSwarm*
#endif

// A box that lights of one range drift in, as pairs of floats [m].
SHARED_STRUCT(DriftBox) {
    float4 min, min_low;        // min.w: the lights' range [m]
    float4 extent, extent_low;  // extent.w: cells per metre of the ordering grid
    // Upper and lower halves. xyz: twice the largest speed [2^-64 turns/s]; w: the cumulative share
    // of the lights, up to and including this box [2^-64], unused in the last box
    uint4 rate_high, rate_low;
};
SHARED_ASSERT(drift_box_size, sizeof(DriftBox) == 96);

// Generated point lights: the parameters from which every light follows.
SHARED_STRUCT(LightSwarm) {
    uint seed_high, seed_low;
    float intensity;  // luminous intensity of the brightest channel [cd]
    uint box_count;   // 1 .. SWARM_BOXES
    float4 gain;      // xyz: factors of every light's intensity
    DriftBox boxes[SWARM_BOXES];
};
SHARED_ASSERT(light_swarm_size, sizeof(LightSwarm) == 32 + SWARM_BOXES * sizeof(DriftBox));

// How a point light drifts along the axes of a box, reflected at its ends. A position is a phase in
// turns: in one turn a light crosses the box and returns.
SHARED_STRUCT(LightDrift) {
    // xyz: turns at time 0, upper and lower halves; w: the box, luminous intensity's red [cd]
    uint4 high, low;
    // xyz: turns a second, two's complement; w: intensity's green and blue
    uint4 rate_high, rate_low;
};
SHARED_ASSERT(light_drift_size, sizeof(LightDrift) == 64);

// A time as halves of two's complement, whole seconds modulo 2^64.
SHARED_STRUCT(DriftTime) {
    uint seconds_high, seconds_low;
    uint rest_high, rest_low;  // [2^-64 s]
};
SHARED_ASSERT(drift_time_size, sizeof(DriftTime) == 16);

SHARED_FN ulong of_halves(uint high, uint low) { return (ulong)high << 32 | low; }
SHARED_FN uint high_half(ulong v) { return (uint)(v >> 32); }
SHARED_FN uint low_half(ulong v) { return (uint)v; }

// The place of a light as a share of its box's extent [2^-63]. Whole turns are dropped.
SHARED_FN ulong drift_share(ulong turns, ulong rate, DriftTime time) {
    ulong is_back = rate >> 63;
    ulong speed = is_back ? 0ul - rate : rate;
    ulong moved = speed * of_halves(time.seconds_high, time.seconds_low) +
                  mul_hi(speed, of_halves(time.rest_high, time.rest_low));
    turns = is_back ? turns - moved : turns + moved;
    return turns >> 63 ? 0ul - turns : turns;
}

// A speed, uniform in +-`twice_max` / 2, from random bits.
SHARED_FN ulong drift_rate(ulong bits, ulong twice_max) {
    ulong is_back = 1ul - (bits >> 63);
    ulong centred = bits ^ 0x8000000000000000ul;
    ulong speed = mul_hi(is_back ? 0ul - centred : centred, twice_max);
    return is_back ? 0ul - speed : speed;
}

// 1 in the fixed point of colours.
#define COLOUR_ONE 0x1000000ul
// clamp(|h - at| - 1, 0, 1) where it falls towards `at`, else clamp(2 - |h - at|, 0, 1).
SHARED_FN ulong hue_ramp(ulong h, ulong at, bool falls) {
    ulong distance = h > at ? h - at : at - h;
    ulong start = falls ? COLOUR_ONE : 2ul * COLOUR_ONE;
    ulong x = falls ? max(distance, start) - start : start - min(distance, start);
    return min(x, COLOUR_ONE);
}

// A channel's intensity [cd]: `pure` mixed with `white`, times the brightest channel's.
SHARED_FN uint drift_channel(ulong pure, ulong white, float intensity) {
    ulong channel = white + ((COLOUR_ONE - white) * pure >> 24);
    return float_bits(float_of((uint)channel) * (1.0f / 16777216.0f) * intensity);
}

// Streams of item_bits().
#define DRIFT_PHASE 0ul  // and the two following: the axes
#define DRIFT_RATE 3ul   // as phase
#define DRIFT_HUE 6ul
#define DRIFT_BOX 7ul

// The intensity of a light: a saturated colour whose brightest channel is 1, a fifth of it white.
// Dark hues get more white, up to a luminance of 0.45, so that blue lights contribute as well.
SHARED_FN LightDrift with_colour(LightDrift d, ulong key, float intensity) {
    ulong h = mul_hi(item_bits(key, DRIFT_HUE), 6ul * COLOUR_ONE);
    ulong r = hue_ramp(h, 3ul * COLOUR_ONE, true);
    ulong g = hue_ramp(h, 2ul * COLOUR_ONE, false);
    ulong b = hue_ramp(h, 4ul * COLOUR_ONE, false);
    ulong luminance = 2126ul * r + 7152ul * g + 722ul * b;  // [1e-4]
    ulong missing = max(4500ul * COLOUR_ONE, luminance) - luminance;
    ulong white = max(COLOUR_ONE / 5ul, missing * COLOUR_ONE / (10000ul * COLOUR_ONE - luminance));
    d.low.w = drift_channel(r, white, intensity);
    d.rate_high.w = drift_channel(g, white, intensity);
    d.rate_low.w = drift_channel(b, white, intensity);
    return d;
}

// Light `light` of a swarm.
SHARED_FN LightDrift swarm_light(SWARM_POINTER swarm, ulong light) {
    ulong key = item_key(of_halves(swarm->seed_high, swarm->seed_low), light);
    LightDrift d;
    uint box = 0;
    if (swarm->box_count > 1) {
        ulong share = item_bits(key, DRIFT_BOX);
        while (box + 1 < swarm->box_count &&
               share >= of_halves(swarm->boxes[box].rate_high.w, swarm->boxes[box].rate_low.w))
            ++box;
    }
    uint4 max_high = swarm->boxes[box].rate_high, max_low = swarm->boxes[box].rate_low;
    d.high.w = box;
#define DRIFT_AXIS(axis, number)                                              \
    {                                                                         \
        ulong phase = item_bits(key, DRIFT_PHASE + number);                   \
        ulong rate = drift_rate(item_bits(key, DRIFT_RATE + number),          \
                                of_halves(max_high.axis, max_low.axis));      \
        d.high.axis = high_half(phase), d.low.axis = low_half(phase);         \
        d.rate_high.axis = high_half(rate), d.rate_low.axis = low_half(rate); \
    }
    DRIFT_AXIS(x, 0ul)
    DRIFT_AXIS(y, 1ul)
    DRIFT_AXIS(z, 2ul)
#undef DRIFT_AXIS
    return with_colour(d, key, swarm->intensity);
}

// Its luminous intensity [cd]. Paths stay as they are where the gain changes.
SHARED_FN float4 drift_intensity(SWARM_POINTER swarm, LightDrift d) {
    return make_float4(bits_float(d.low.w) * swarm->gain.x,
                       bits_float(d.rate_high.w) * swarm->gain.y,
                       bits_float(d.rate_low.w) * swarm->gain.z, 0.0f);
}

// The share of the box's extent along an axis, see drift_share().
#define DRIFT_SHARE(d, axis, time)                      \
    drift_share(of_halves((d).high.axis, (d).low.axis), \
                of_halves((d).rate_high.axis, (d).rate_low.axis), time)

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
