// SPDX-License-Identifier: Apache-2.0
// Textures as resolve_surfaces samples them: 16 bits a channel, linear, with all mip levels.
// A mip level averages the level before it: 2x2 texels, or for odd sizes the linear filter's value
// at the new texel's centre. One work-item makes one texel.

#include "kernels/shared/mips.h"

kernel void mip_next(global ulong* texels,  // in and out
                     uint above_first, uint above_width, uint above_height, uint first) {
    uint width = max(above_width / 2u, 1u);
    uint height = max(above_height / 2u, 1u);
    uint i = get_global_id(0);
    if (i >= width * height) return;
    MipTaps s = mip_taps(i % width, width, above_width);
    MipTaps t = mip_taps(i / width, height, above_height);
    global const ulong* top = texels + above_first + t.first * above_width;
    global const ulong* bottom = texels + above_first + t.second * above_width;
    texels[first + i] = mean_texel(top[s.first], top[s.second], bottom[s.first], bottom[s.second],
                                   s.share, t.share);
}
