// SPDX-License-Identifier: Apache-2.0
// Triangles in lanes, with their vertices rotated so that products of edges lose least.
#ifndef KILOLUX_DEVICE_LONGEST_EDGE_H
#define KILOLUX_DEVICE_LONGEST_EDGE_H
#include "kernels/device/lanes.h"

// A norm without a root: the sum of magnitudes.
static inline FV size3(FV3 v) { return fabs(v.x) + fabs(v.y) + fabs(v.z); }

// Rotates the triangles' vertices so that the longest edge is opposite to the first: the product of
// the shorter two loses least.
static inline void turn_from_longest(FV3* v) {
    FV opposite[3];
    for (uint i = 0; i < 3; ++i) {
        opposite[i] = size3(sub3(v[(i + 2) % 3], v[(i + 1) % 3]));
    }
    MASK second = lane_mask(opposite[1] > opposite[0]) & lane_mask(opposite[1] >= opposite[2]);
    MASK third = lane_mask(opposite[2] > opposite[0]) & lane_mask(opposite[2] > opposite[1]);
    FV3 turned[3];
    for (uint i = 0; i < 3; ++i) {
        turned[i] = select3(second, v[(i + 1) % 3], select3(third, v[(i + 2) % 3], v[i]));
    }
    for (uint i = 0; i < 3; ++i) v[i] = turned[i];
}
#endif
