// SPDX-License-Identifier: Apache-2.0
// Mip levels, for C++ and OpenCL C: a level averages the level before it, 2x2 texels, or for odd
// sizes the linear filter's value at the new texel's centre. Texels have 16 bits a channel, red
// lowest.
#ifndef KILOLUX_SHARED_MIPS_H
#define KILOLUX_SHARED_MIPS_H
#include "kernels/shared/types.h"
#if defined(__cplusplus)
namespace kilolux {
#endif

// Neighbours of a coordinate in a level and their weights.
SHARED_PLAIN_STRUCT(MipTaps) {
    uint first, second;
    float share;
};

SHARED_FN MipTaps mip_taps(uint at, uint size, uint above) {
    float centre = (float_of(at) + 0.5f) * (float_of(above) / float_of(size)) - 0.5f;
    float whole = floor(centre);
    MipTaps taps;
    taps.share = centre - whole;
    taps.first = uint_of(max(whole, 0.0f));
    taps.second = min(uint_of(whole + 1.0f), above - 1u);
    return taps;
}

SHARED_FN ulong make_texel(uint r, uint g, uint b, uint a) {
    uint low = r | (g << 16);
    uint high = b | (a << 16);
    return low | ((ulong)high << 32);
}

// The mean of one channel, from bit `shift` on.
SHARED_FN uint mean_channel(ulong a, ulong b, ulong c, ulong d, uint shift, float s, float t) {
    float left_top = float_of((uint)(a >> shift) & 0xffffu);
    float right_top = float_of((uint)(b >> shift) & 0xffffu);
    float left_bottom = float_of((uint)(c >> shift) & 0xffffu);
    float right_bottom = float_of((uint)(d >> shift) & 0xffffu);
    float upper = fma(s, right_top - left_top, left_top);
    float lower = fma(s, right_bottom - left_bottom, left_bottom);
    return uint_of(fma(t, lower - upper, upper) + 0.5f);
}

// The mean of the upper and lower pairs of neighbours; s, t: the shares of the right and lower
// ones.
SHARED_FN ulong mean_texel(ulong a, ulong b, ulong c, ulong d, float s, float t) {
    return make_texel(mean_channel(a, b, c, d, 0u, s, t), mean_channel(a, b, c, d, 16u, s, t),
                      mean_channel(a, b, c, d, 32u, s, t), mean_channel(a, b, c, d, 48u, s, t));
}

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
