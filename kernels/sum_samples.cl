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
    FV value = load_lanes(values + i);
    FV high = fv(0.0f), middle = fv(0.0f), low = fv(0.0f);
    if (is_first == 0) {
        high = load_lanes(sums + i);
        middle = load_lanes(sums + count + i);
        low = load_lanes(sums + 2 * count + i);
    }
    FV error = two_sum(high, value, &high);
    error = two_sum(middle, error, &middle);
    store_lanes(high, sums + i);
    store_lanes(middle, sums + count + i);
    store_lanes(low + error, sums + 2 * count + i);
}

// The sum / `samples`, rounded once: the remainder of each quotient is divided, too.
kernel void sum_samples_mean(uint count, float samples,
                             global const float* restrict sums,  // [3][count]
                             global float* restrict means) {     // out [count]
    uint i = (uint)get_global_id(0) * VW;
    if (i >= count) return;
    FV first = load_lanes(sums + i);
    FV n = fv(samples);
    FV high, middle, low;
    middle = two_sum(first, load_lanes(sums + count + i), &high);
    low = two_sum(middle, load_lanes(sums + 2 * count + i), &middle);
    middle = two_sum(high, middle, &high) + low;
    FV quotient = high / n;
    FV rest = fma(-quotient, n, high) + middle;
    FV next = rest / n;
    next += fma(-next, n, rest) / n;
    // An infinite sum has no errors to add.
    store_lanes(select_fv(first - first == fv(0.0f), quotient + next, first), means + i);
}
