// SPDX-License-Identifier: Apache-2.0
// Measures the highest rates of the device, for the limits of stages. Arithmetic: every work-item
// keeps enough independent chains of FV in registers to hide the units' latencies (two FMA pipes of
// 4..5 cycles need 8..10), on numbers that neither grow nor become denormal. Memory: every
// work-item walks `count` vectors, `step` apart from `item * item_step` on; neighbouring work-items
// take neighbouring vectors on GPUs (item_step 1), a contiguous range each on CPUs (step 1).
#include "kernels/device/lanes.h"

#define EACH_10(op) op(0) op(1) op(2) op(3) op(4) op(5) op(6) op(7) op(8) op(9)
#define EACH_4(op) op(0) op(1) op(2) op(3)
#define FMA_CHAINS 10
#define ADD_CHAINS 4

#define DECLARE_X(i) FV x##i = start + (i)*0.01f;
#define DECLARE_Y(i) FV y##i = start - (i)*0.01f;
#define ADD_X(i) sum += x##i;
#define ADD_Y(i) sum += y##i;
#define FMA_X(i) x##i = fma(x##i, fv(a), fv(b));
#define ADD_TO_Y(i) y##i = y##i + fv(b);
#define RSQRT_X(i) x##i = rsqrt(x##i + fv(b));
#define SQRT_X(i) x##i = sqrt(x##i + fv(b));
#define DIVIDE_X(i) x##i = fv(a) / x##i;

// FMA_CHAINS fused multiply-adds a lane and iteration.
kernel void fma_rate(uint iterations, float a, float b,
                     global float* restrict out) {  // out [items][VW]
    FV start = lane_to_float(lane_numbers) * 0.001f + 0.5f;
    EACH_10(DECLARE_X)
    for (uint i = 0; i < iterations; ++i) {
        EACH_10(FMA_X)
    }
    FV sum = fv(0.0f);
    EACH_10(ADD_X)
    lane_store(sum, out + get_global_id(0) * VW);
}

// The same with ADD_CHAINS additions beside: evaluate() has about as many that need no multiplier,
// and some CPUs add on other pipes than they multiply on.
kernel void instruction_rate(uint iterations, float a, float b,
                             global float* restrict out) {  // out [items][VW]
    FV start = lane_to_float(lane_numbers) * 0.001f + 0.5f;
    EACH_10(DECLARE_X)
    EACH_4(DECLARE_Y)
    for (uint i = 0; i < iterations; ++i) {
        EACH_10(FMA_X)
        EACH_4(ADD_TO_Y)
    }
    FV sum = fv(0.0f);
    EACH_10(ADD_X)
    EACH_4(ADD_Y)
    lane_store(sum, out + get_global_id(0) * VW);
}

// Special functions as the shading kernels' compiler makes them, FMA_CHAINS a lane and iteration.
kernel void rsqrt_rate(uint iterations, float a, float b,
                       global float* restrict out) {  // out [items][VW]
    FV start = lane_to_float(lane_numbers) * 0.001f + 0.5f;
    EACH_10(DECLARE_X)
    for (uint i = 0; i < iterations; ++i) {
        EACH_10(RSQRT_X)
    }
    FV sum = fv(a);
    EACH_10(ADD_X)
    lane_store(sum, out + get_global_id(0) * VW);
}

kernel void sqrt_rate(uint iterations, float a, float b,
                      global float* restrict out) {  // out [items][VW]
    FV start = lane_to_float(lane_numbers) * 0.001f + 0.5f;
    EACH_10(DECLARE_X)
    for (uint i = 0; i < iterations; ++i) {
        EACH_10(SQRT_X)
    }
    FV sum = fv(a);
    EACH_10(ADD_X)
    lane_store(sum, out + get_global_id(0) * VW);
}

kernel void division_rate(uint iterations, float a, float b,
                          global float* restrict out) {  // out [items][VW]
    FV start = lane_to_float(lane_numbers) * 0.001f + 0.5f;
    EACH_10(DECLARE_X)
    for (uint i = 0; i < iterations; ++i) {
        EACH_10(DIVIDE_X)
    }
    FV sum = fv(b);
    EACH_10(ADD_X)
    lane_store(sum, out + get_global_id(0) * VW);
}

// Does nothing: measures the cost of a launch.
kernel void launch_nothing(global float* restrict out) { (void)out; }

kernel void write_memory(uint repeats, uint count, uint item_step, uint step,
                         global float* restrict to,  // out [items * count][VW]
                         global float* restrict from, global float* restrict out) {
    size_t first = (size_t)get_global_id(0) * item_step;
    for (uint r = 0; r < repeats; ++r) {
        FV value = fv((float)(r + 1));
        for (uint i = 0; i < count; ++i) lane_store(value, to + (first + (size_t)i * step) * VW);
    }
}

kernel void copy_memory(uint repeats, uint count, uint item_step, uint step,
                        global float* restrict to,    // out [items * count][VW]
                        global float* restrict from,  // [items * count][VW]
                        global float* restrict out) {
    size_t first = (size_t)get_global_id(0) * item_step;
    for (uint r = 0; r < repeats; ++r) {
        for (uint i = 0; i < count; ++i) {
            size_t place = (first + (size_t)i * step) * VW;
            lane_store(lane_load(from + place), to + place);
        }
    }
}

// Four sums, so that additions do not wait for each other; `count` is a multiple of 4.
kernel void read_memory(uint repeats, uint count, uint item_step, uint step,
                        global float* restrict to,
                        global float* restrict from,   // [items * count][VW]
                        global float* restrict out) {  // out [items][VW]
    size_t first = (size_t)get_global_id(0) * item_step;
    FV sum0 = fv(0.0f), sum1 = fv(0.0f), sum2 = fv(0.0f), sum3 = fv(0.0f);
    for (uint r = 0; r < repeats; ++r) {
        for (uint i = 0; i < count; i += 4) {
            global const float* place = from + (first + (size_t)i * step) * VW;
            size_t next = (size_t)step * VW;
            sum0 += lane_load(place);
            sum1 += lane_load(place + next);
            sum2 += lane_load(place + 2 * next);
            sum3 += lane_load(place + 3 * next);
        }
    }
    lane_store((sum0 + sum1) + (sum2 + sum3), out + get_global_id(0) * VW);
}
