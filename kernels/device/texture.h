// SPDX-License-Identifier: Apache-2.0
// Textures at VW pixels: mip-mapped linear filtering as OpenGL 4.5 (8.14) states it, without its
// freedoms. The same text is in host/measure/reference/texture_sampler.h, in double.
//
// MAX_ANISOTROPY > 1: up to so many samples along the longer side of the pixel's footprint, whose
// mip level is that of the side's share (EXT_texture_filter_anisotropic).
#ifndef KILOLUX_DEVICE_TEXTURE_H
#define KILOLUX_DEVICE_TEXTURE_H
#include "kernels/device/lanes.h"
#include "kernels/shared/surface_scene.h"

#ifndef MAX_ANISOTROPY
#define MAX_ANISOTROPY 1
#endif

typedef struct TextureBuffers {
    global const TextureRow* rows;
    global const ulong* texels;
} TextureBuffers;

typedef struct FV4 {
    FV x, y, z, w;
} FV4;

// Coordinates in a texture and their change to the right and lower neighbour pixel.
typedef struct Footprint {
    FV u, v;
    FV u_dx, v_dx, u_dy, v_dy;
} Footprint;

#if VW == 1
#define TEXEL_VECTOR ulong
#else
#define TEXEL_VECTOR KX_CONCAT(ulong, VW)
#endif
#define TEXEL_LOW(t) KX_CONCAT(convert_, UV)((t) & (TEXEL_VECTOR)(0xffffffffu))
#define TEXEL_HIGH(t) KX_CONCAT(convert_, UV)((t) >> (TEXEL_VECTOR)(32))

// log2 of x > 0, absolute error 4e-7: the exponent, and a minimax polynomial of the mantissa. Only
// products and sums, so that every device gets the same bits.
static inline FV lane_log2(FV x) {
    UV bits = lane_bits(x);
    FV exponent = lane_from_int((bits >> 23) - 127u);
    FV t = lane_from_bits((bits & 0x7fffffu) | 0x3f800000u) - 1.0f;
    FV q = fma(t, fv(-0.0152090989f), fv(0.0633258372f));
    q = fma(t, q, fv(-0.129703768f));
    q = fma(t, q, fv(0.195436383f));
    q = fma(t, q, fv(-0.277887795f));
    q = fma(t, q, fv(0.44266644f));
    return exponent + fma(t * (1.0f - t), q, t);
}

// A wrapped coordinate in texels, from the texel centre before it on: its neighbours and the share
// of the second one.
typedef struct Taps {
    UV first, second;
    FV share;
} Taps;

// `size` texels; `nearest`: 1 where one texel is wanted, else 0.
static inline Taps taps_of(FV coordinate, FV size, uint wrap, FV nearest) {
    FV wrapped = coordinate - floor(coordinate);
    if (wrap == WRAP_MIRROR) {
        FV twice = coordinate - 2.0f * floor(0.5f * coordinate);
        wrapped = lane_select(twice > fv(1.0f), 2.0f - twice, twice);
    } else if (wrap == WRAP_CLAMP) {
        wrapped = min(max(coordinate, fv(0.0f)), fv(1.0f));
    }
    FV at = fma(wrapped, size, fma(nearest, fv(0.5f), fv(-0.5f)));
    FV whole = floor(at);
    Taps out;
    out.share = (at - whole) * (1.0f - nearest);
    FV last = size - 1.0f;
    FV next = whole + 1.0f;
    if (wrap == WRAP_REPEAT) {
        FV before = lane_select(whole < fv(0.0f), last, whole);
        next = lane_select(next > last, fv(0.0f), next);
        whole = lane_select(before > last, fv(0.0f), before);
    }
    // The negation also keeps a coordinate that is not a number inside.
    out.first = lane_to_uint(min(max(whole, fv(0.0f)), last));
    out.second = lane_to_uint(min(max(next, fv(0.0f)), last));
    return out;
}

#define TEXEL_AT(i, texels, place) (texels)[(place)[i]]

static inline TEXEL_VECTOR gather_texels(global const ulong* texels, UV place) {
#if VW == 1
    return texels[place];
#else
    uint index[VW];
    lane_store(place, index);
    return LANES(TEXEL_VECTOR, TEXEL_AT, texels, index);
#endif
}

static inline FV channel_mix(UV a, UV b, UV c, UV d, uint shift, FV s, FV t) {
    FV fa = lane_to_float((a >> shift) & 0xffffu);
    FV fb = lane_to_float((b >> shift) & 0xffffu);
    FV fc = lane_to_float((c >> shift) & 0xffffu);
    FV fd = lane_to_float((d >> shift) & 0xffffu);
    FV top = fma(s, fb - fa, fa);
    FV bottom = fma(s, fd - fc, fc);
    return fma(t, bottom - top, top);
}

// In 65535ths, of the mip levels `level`.
static inline FV4 sample_level(TextureBuffers buffers, global const TextureRow* row, UV level, FV u,
                               FV v, FV nearest) {
    UV width = max((UV)(row->width) >> level, (UV)(1u));
    UV height = max((UV)(row->height) >> level, (UV)(1u));
    Taps s = taps_of(u, lane_to_float(width), row->wrap_s, nearest);
    Taps t = taps_of(v, lane_to_float(height), row->wrap_t, nearest);
#if VW == 1
    UV first = row->first_texel[level];
#else
    uint levels[VW];
    lane_store(level, levels);
    UV first = lane_gather(UV, row->first_texel, levels);
#endif
    UV top = first + t.first * width;
    UV bottom = first + t.second * width;
    TEXEL_VECTOR a = gather_texels(buffers.texels, top + s.first);
    TEXEL_VECTOR b = gather_texels(buffers.texels, top + s.second);
    TEXEL_VECTOR c = gather_texels(buffers.texels, bottom + s.first);
    TEXEL_VECTOR d = gather_texels(buffers.texels, bottom + s.second);
    UV la = TEXEL_LOW(a);
    UV lb = TEXEL_LOW(b);
    UV lc = TEXEL_LOW(c);
    UV ld = TEXEL_LOW(d);
    UV ha = TEXEL_HIGH(a);
    UV hb = TEXEL_HIGH(b);
    UV hc = TEXEL_HIGH(c);
    UV hd = TEXEL_HIGH(d);
    FV4 out;
    out.x = channel_mix(la, lb, lc, ld, 0, s.share, t.share);
    out.y = channel_mix(la, lb, lc, ld, 16, s.share, t.share);
    out.z = channel_mix(ha, hb, hc, hd, 0, s.share, t.share);
    out.w = channel_mix(ha, hb, hc, hd, 16, s.share, t.share);
    return out;
}

static inline FV lane_mix(FV a, FV b, FV share) { return fma(share, b - a, a); }

// Which mip levels a footprint reads, and how.
typedef struct MipChoice {
    UV lower;
    FV upper_share;  // of the level after `lower`
    FV nearest;      // 1: one texel of a level; 0: linear
} MipChoice;

// lambda: log2 of the footprint in texels.
static inline MipChoice choose_mips(global const TextureRow* row, FV lambda) {
    MASK magnified = lane_mask(!(lambda > fv(0.0f)));
    uint filter = row->filter;
    FV magnify = fv((filter & FILTER_MAGNIFY_NEAREST) != 0u ? 1.0f : 0.0f);
    FV minify = fv((filter & FILTER_MINIFY_NEAREST) != 0u ? 1.0f : 0.0f);
    FV level = min(max(lambda, fv(0.0f)), fv((float)(row->levels - 1u)));
    if ((filter & FILTER_NO_MIPMAPS) != 0u) level = fv(0.0f);
    if ((filter & FILTER_NEAREST_MIPMAP) != 0u) level = ceil(level + 0.5f) - 1.0f;
    level = lane_select(magnified, fv(0.0f), level);
    FV lower = floor(level);
    MipChoice out;
    out.nearest = lane_select(magnified, magnify, minify);
    out.lower = lane_to_uint(lower);
    out.upper_share = level - lower;
    return out;
}

// In 65535ths, with the mip levels that `mips` names.
static inline FV4 sample_mips(TextureBuffers buffers, global const TextureRow* row, MipChoice mips,
                              FV u, FV v) {
    FV4 out = sample_level(buffers, row, mips.lower, u, v, mips.nearest);
    if (!lane_any(lane_mask(mips.upper_share > fv(0.0f)))) return out;
    UV upper = min(mips.lower + 1u, (UV)(row->levels - 1u));
    FV4 above = sample_level(buffers, row, upper, u, v, mips.nearest);
    out.x = lane_mix(out.x, above.x, mips.upper_share);
    out.y = lane_mix(out.y, above.y, mips.upper_share);
    out.z = lane_mix(out.z, above.z, mips.upper_share);
    out.w = lane_mix(out.w, above.w, mips.upper_share);
    return out;
}

#if MAX_ANISOTROPY > 1
static inline bool is_anisotropic(global const TextureRow* row) {
    return (row->filter & (FILTER_MINIFY_NEAREST | FILTER_NO_MIPMAPS)) == 0u;
}

// across2: squared lengths of the footprint's sides in texels.
static inline FV4 sample_anisotropic(TextureBuffers buffers, global const TextureRow* row,
                                     Footprint at, FV across2_x, FV across2_y) {
    MASK along_x = lane_mask(across2_x >= across2_y);
    FV longer = max(across2_x, across2_y);
    FV shorter = max(min(across2_x, across2_y), fv(1e-30f));
    FV count = min(max(ceil(lane_sqrt(longer / shorter)), fv(1.0f)), fv((float)MAX_ANISOTROPY));
    FV step_u = lane_select(along_x, at.u_dx, at.u_dy) / count;
    FV step_v = lane_select(along_x, at.v_dx, at.v_dy) / count;
    MipChoice mips = choose_mips(row, 0.5f * lane_log2(max(longer / (count * count), fv(1e-30f))));
    float most = lane_max(count);
    FV4 sum;
    sum.x = sum.y = sum.z = sum.w = fv(0.0f);
    for (float i = 0.0f; i < most; i += 1.0f) {
        FV along = fma(count, fv(-0.5f), fv(i + 0.5f));
        FV4 tap = sample_mips(buffers, row, mips, fma(step_u, along, at.u),
                              fma(step_v, along, at.v));
        FV weight = lane_select(fv(i) < count, fv(1.0f) / count, fv(0.0f));
        sum.x = fma(tap.x, weight, sum.x);
        sum.y = fma(tap.y, weight, sum.y);
        sum.z = fma(tap.z, weight, sum.z);
        sum.w = fma(tap.w, weight, sum.w);
    }
    return sum;
}
#endif

// RGBA of texture `texture`, linear.
static inline FV4 sample_texture(TextureBuffers buffers, uint texture, Footprint at) {
    global const TextureRow* row = buffers.rows + texture;
    float width = (float)row->width;
    float height = (float)row->height;
    FV ux = at.u_dx * width;
    FV vx = at.v_dx * height;
    FV uy = at.u_dy * width;
    FV vy = at.v_dy * height;
    FV across2_x = fma(ux, ux, vx * vx);
    FV across2_y = fma(uy, uy, vy * vy);
    FV4 out;
#if MAX_ANISOTROPY > 1
    if (is_anisotropic(row)) {
        out = sample_anisotropic(buffers, row, at, across2_x, across2_y);
    } else
#endif
    {
        FV longest2 = max(max(across2_x, across2_y), fv(1e-30f));
        out = sample_mips(buffers, row, choose_mips(row, 0.5f * lane_log2(longest2)), at.u, at.v);
    }
    const float scale = 1.0f / 65535.0f;
    out.x *= scale;
    out.y *= scale;
    out.z *= scale;
    out.w *= scale;
    return out;
}
#endif
