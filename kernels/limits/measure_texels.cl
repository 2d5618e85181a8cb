// SPDX-License-Identifier: Apache-2.0
// Measures how many texels a device reads at best: the limit of stages that sample textures.
// TEXELS: of the table, a power of two.
#include "kernels/device/texture.h"

#define EACH_4(op) op(0) op(1) op(2) op(3)
#define TAKE_TEXELS(i)                                            \
    texels = gather_texels(table, place ^ (UV)(i * TEXELS / 4u)); \
    low##i ^= texels.low;                                         \
    high##i ^= texels.high;
#define DECLARE_TEXELS(i) UV low##i = (UV)(0u), high##i = (UV)(0u);
#define JOIN_TEXELS(i) sum ^= low##i ^ high##i;

// Four texels a lane and iteration from places that neighbouring lanes have side by side.
kernel void texel_rate(uint iterations,
                       global const ulong* restrict table,  // [TEXELS]
                       global float* restrict out) {        // out [items][VW]
    UV place = lane_numbers;
    Texels texels;
    EACH_4(DECLARE_TEXELS)
    for (uint i = 0; i < iterations; ++i) {
        place = (lane_numbers ^ (UV)(i * 37u)) & (TEXELS - 1u);
        EACH_4(TAKE_TEXELS)
    }
    UV sum = place;
    EACH_4(JOIN_TEXELS)
    lane_store(lane_to_float(sum & 1u), out + get_global_id(0) * VW);
}
