// SPDX-License-Identifier: Apache-2.0
// Textures as resolve_surfaces samples them: 16 bits a channel, linear, with all mip levels.
// A mip level averages the level before it: 2x2 texels, or for odd sizes the linear filter's value
// at the new texel's centre. One work-item makes one texel.

static inline uint4 channels_of(ulong texel) {
    return (uint4)((uint)texel & 0xffffu, (uint)(texel >> 16) & 0xffffu,
                   (uint)(texel >> 32) & 0xffffu, (uint)(texel >> 48));
}

static inline ulong texel_of(uint4 c) {
    return (ulong)(c.x | (c.y << 16)) | ((ulong)(c.z | (c.w << 16)) << 32);
}

// Level 0 from an 8-bit image.
kernel void mip_first(global const uchar4* restrict image,    // [count]
                      global const ushort* restrict decoded,  // [256]: of a colour's code
                      uint count,
                      uint first,                     // of the level, in texels
                      global ulong* restrict texels)  // out
{
    uint i = get_global_id(0);
    if (i >= count) return;
    uchar4 code = image[i];
    // 257: 255 is 65535.
    texels[first + i] =
        texel_of((uint4)(decoded[code.x], decoded[code.y], decoded[code.z], 257u * (uint)code.w));
}

// Neighbours of a coordinate in a level and their weights.
typedef struct MipTaps {
    uint first, second;
    float share;
} MipTaps;

static inline MipTaps mip_taps(uint at, uint size, uint above) {
    float centre = ((float)at + 0.5f) * ((float)above / (float)size) - 0.5f;
    float whole = floor(centre);
    MipTaps out;
    out.share = centre - whole;
    out.first = (uint)max(whole, 0.0f);
    out.second = min((uint)(whole + 1.0f), above - 1u);
    return out;
}

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
    float4 a = convert_float4(channels_of(top[s.first]));
    float4 b = convert_float4(channels_of(top[s.second]));
    float4 c = convert_float4(channels_of(bottom[s.first]));
    float4 d = convert_float4(channels_of(bottom[s.second]));
    float4 upper = fma((float4)(s.share), b - a, a);
    float4 lower = fma((float4)(s.share), d - c, c);
    float4 mean = fma((float4)(t.share), lower - upper, upper);
    texels[first + i] = texel_of(convert_uint4(mean + 0.5f));
}
