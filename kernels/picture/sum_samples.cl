// SPDX-License-Identifier: Apache-2.0
// Mean of pictures. A sum is three floats, each the rounding error of the one before it: more bits
// than float64 (two_sum: Knuth, TAOCP vol. 2, 4.2.2). One work-item takes VW neighbouring values.
#include "kernels/device/lanes.h"

// a + b = *sum + error, exactly.
static inline FV two_sum(FV a, FV b, private FV* sum) {
    FV s = a + b;
    FV b_part = s - a;
    *sum = s;
    return (a - (s - b_part)) + (b - b_part);
}

kernel void sum_samples_add(uint count, uint is_first,
                            global const float* restrict values,  // [count]
                            global float* restrict sums) {        // in, out [3][count]
    uint i = (uint)get_global_id(0) * VW;
    if (i >= count) return;
    FV value = lane_load(values + i);
    FV high = fv(0.0f), middle = fv(0.0f), low = fv(0.0f);
    if (is_first == 0) {
        high = lane_load(sums + i);
        middle = lane_load(sums + count + i);
        low = lane_load(sums + 2 * count + i);
    }
    FV error = two_sum(high, value, &high);
    error = two_sum(middle, error, &middle);
    lane_store(high, sums + i);
    lane_store(middle, sums + count + i);
    lane_store(low + error, sums + 2 * count + i);
}

// The sum / `samples`, rounded once: the remainder of each quotient is divided, too.
kernel void sum_samples_mean(uint count, float samples,
                             global const float* restrict sums,  // [3][count]
                             global float* restrict means) {     // out [count]
    uint i = (uint)get_global_id(0) * VW;
    if (i >= count) return;
    FV first = lane_load(sums + i);
    FV n = fv(samples);
    FV high, middle, low;
    middle = two_sum(first, lane_load(sums + count + i), &high);
    low = two_sum(middle, lane_load(sums + 2 * count + i), &middle);
    middle = two_sum(high, middle, &high) + low;
    FV quotient = high / n;
    FV rest = fma(-quotient, n, high) + middle;
    FV next = rest / n;
    next += fma(-next, n, rest) / n;
    // An infinite sum has no errors to add.
    lane_store(lane_select(first - first == fv(0.0f), quotient + next, first), means + i);
}
