// SPDX-License-Identifier: Apache-2.0
// Generated lights that move.
#ifndef KILOLUX_SHARED_LIGHT_DRIFT_H
#define KILOLUX_SHARED_LIGHT_DRIFT_H
#include "kernels/shared/types.h"

#if defined(__cplusplus)
namespace kilolux {
#endif

// How a point light drifts along the axes of a box, reflected at its ends. Positions are turns of
// 2^-64: a period is twice the box's extent.
SHARED_STRUCT(LightDrift) {
    // xyz: turns at the start, upper and lower halves; w: the box, luminous intensity's red [cd]
    uint4 high, low;
    // xyz: turns a second, two's complement; w: intensity's green and blue
    uint4 rate_high, rate_low;
};
SHARED_ASSERT(light_drift_size, sizeof(LightDrift) == 64);

// A box that lights of one range drift in, as pairs of floats [m].
SHARED_STRUCT(DriftBox) {
    float4 min, min_low;        // min.w: the lights' range [m]
    float4 extent, extent_low;  // extent.w: cells of the lights' order a metre
};
SHARED_ASSERT(drift_box_size, sizeof(DriftBox) == 64);

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
