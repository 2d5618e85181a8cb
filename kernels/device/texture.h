// SPDX-License-Identifier: Apache-2.0
// Textures at VW pixels: mip-mapped linear filtering as OpenGL 4.5 (8.14) states it, without its
// freedoms; host/measure/reference/texture_sampler.h is the same in double.
//
// Where a pixel reads, a Lookup, is kept apart from what it reads: a material's textures of one
// size and wrapping share it. Places are relative to a texture's first texel.
//
// Compile-time switches, each 1 where some texture of the scene needs it: HAS_NEAREST (filters
// other than linear between texels and levels), HAS_WRAPS (other than repeat), HAS_UV_TRANSFORM.
// MAX_ANISOTROPY > 1: up to so many samples along the longer side of the pixel's footprint, whose
// mip level is that of the side's share (EXT_texture_filter_anisotropic).
#ifndef KILOLUX_DEVICE_TEXTURE_H
#define KILOLUX_DEVICE_TEXTURE_H
#include "kernels/device/lanes.h"
#include "kernels/device/prefetch.h"
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

// The four texels about a point of a mip level, and the point's place between them.
typedef struct LevelLookup {
    UV upper_left, upper_right, lower_left, lower_right;  // from the texture's first texel on
    FV s, t;
} LevelLookup;

// Which texels a point reads.
typedef struct Lookup {
    LevelLookup level;
    LevelLookup coarser;
    FV coarser_share;
    bool two_levels;  // else coarser_share is 0 in all lanes
} Lookup;

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

// A coordinate's neighbours along one axis, and its place between them.
typedef struct Taps {
    UV first, second;
    FV share;
} Taps;

#if HAS_WRAPS
// A coordinate in [0, 1], where `wrap` is not to repeat: its neighbours end at the edges.
static inline FV within_edges(FV coordinate, uint wrap) {
    if (wrap == WRAP_CLAMP) return min(max(coordinate, fv(0.0f)), fv(1.0f));
    FV twice = coordinate - 2.0f * floor(0.5f * coordinate);
    return lane_select(twice > fv(1.0f), 2.0f - twice, twice);
}
#endif

// Of `size` texels; `nearest`: 1 where one texel is wanted, else 0.
static inline Taps taps_of(FV coordinate, UV size, uint wrap, FV nearest) {
    FV in_texture = coordinate - floor(coordinate);
#if HAS_WRAPS
    if (wrap != WRAP_REPEAT) in_texture = within_edges(coordinate, wrap);
#endif
    FV middle = fv(-0.5f);
#if HAS_NEAREST
    middle = fma(nearest, fv(0.5f), middle);
#endif
    FV at = fma(in_texture, lane_to_float(size), middle);
    FV whole = floor(at);
    UV last = size - 1u;
    UV place = lane_truncate(whole);
    MASK before = lane_mask(whole < fv(0.0f));
    UV first = select(place, last, before);
    MASK after = lane_mask(first >= last);
    UV second = select(first + 1u, (UV)(0u), after);
#if HAS_WRAPS
    if (wrap != WRAP_REPEAT) {
        first = select(place, (UV)(0u), before);
        second = min(place + 1u, last);
    }
#endif
    Taps out;
    // A coordinate that is not a number must stay inside, too.
    out.first = min(first, last);
    out.second = min(second, last);
    out.share = at - whole;
#if HAS_NEAREST
    out.share *= 1.0f - nearest;
#endif
    return out;
}

// The texels about (u, v) in the mip levels `level`.
static inline LevelLookup lookup_level(global const TextureRow* row, UV level, FV u, FV v,
                                       FV nearest) {
    UV width = max((UV)(row->width) >> level, (UV)(1u));
    UV height = max((UV)(row->height) >> level, (UV)(1u));
    Taps s = taps_of(u, width, row->wrap_s, nearest);
    Taps t = taps_of(v, height, row->wrap_t, nearest);
#if VW == 1
    UV first = row->level_offset[level];
#else
    uint levels[VW];
    lane_store(level, levels);
    UV first = lane_gather(UV, row->level_offset, levels);
#endif
    UV top = first + t.first * width;
    UV bottom = first + t.second * width;
    LevelLookup out;
    out.upper_left = top + s.first;
    out.upper_right = top + s.second;
    out.lower_left = bottom + s.first;
    out.lower_right = bottom + s.second;
    out.s = s.share;
    out.t = t.share;
    return out;
}

// The texels about (u, v); lambda: log2 of the footprint in texels.
static inline Lookup make_lookup(global const TextureRow* row, FV u, FV v, FV lambda) {
    FV level = min(max(lambda, fv(0.0f)), fv((float)(row->levels - 1u)));
    FV nearest = fv(0.0f);
#if HAS_NEAREST
    MASK magnified = lane_mask(!(lambda > fv(0.0f)));
    uint filter = row->filter;
    FV magnify = fv((filter & FILTER_MAGNIFY_NEAREST) != 0u ? 1.0f : 0.0f);
    FV minify = fv((filter & FILTER_MINIFY_NEAREST) != 0u ? 1.0f : 0.0f);
    nearest = lane_select(magnified, magnify, minify);
    if ((filter & FILTER_NO_MIPMAPS) != 0u) level = fv(0.0f);
    if ((filter & FILTER_NEAREST_MIPMAP) != 0u) {
        level = lane_select(magnified, fv(0.0f), ceil(level + 0.5f) - 1.0f);
    }
#endif
    FV finer = floor(level);
    UV number = lane_to_uint(finer);
    Lookup out;
    out.coarser_share = level - finer;
    out.two_levels = lane_any(lane_mask(out.coarser_share > fv(0.0f)));
    out.level = lookup_level(row, number, u, v, nearest);
    out.coarser = out.level;
    if (out.two_levels) {
        UV next = min(number + 1u, (UV)(row->levels - 1u));
        out.coarser = lookup_level(row, next, u, v, nearest);
    }
    return out;
}

// Texels of 64 bits in lanes, as their low and high halves.
typedef struct Texels {
    UV low, high;
} Texels;

// Pairs of words are loaded one by one: compilers would make a gather of single elements, which
// CPUs run slower (Zen 4: half as fast).
static inline Texels gather_texels(global const ulong* texels, UV place) {
    Texels out;
    global const uint2* pairs = (global const uint2*)texels;
#if VW == 1
    uint2 all = pairs[place];
    out.low = all.x;
    out.high = all.y;
#else
    uint at[VW];
    lane_store(place, at);
#if VW == 2
    uint4 all = (uint4)(pairs[at[0]], pairs[at[1]]);
#elif VW == 4
    uint8 all = (uint8)(pairs[at[0]], pairs[at[1]], pairs[at[2]], pairs[at[3]]);
#else
    uint16 all = (uint16)(pairs[at[0]], pairs[at[1]], pairs[at[2]], pairs[at[3]], pairs[at[4]],
                          pairs[at[5]], pairs[at[6]], pairs[at[7]]);
#endif
#if VW == 16
    uint16 rest = (uint16)(pairs[at[8]], pairs[at[9]], pairs[at[10]], pairs[at[11]], pairs[at[12]],
                           pairs[at[13]], pairs[at[14]], pairs[at[15]]);
    out.low = (uint16)(all.even, rest.even);
    out.high = (uint16)(all.odd, rest.odd);
#else
    out.low = all.even;
    out.high = all.odd;
#endif
#endif
    return out;
}

static inline FV lane_mix(FV a, FV b, FV share) { return fma(share, b - a, a); }

static inline FV mix_corners(UV a, UV b, UV c, UV d, const LevelLookup* at) {
    FV top = lane_mix(lane_from_int(a), lane_from_int(b), at->s);
    FV bottom = lane_mix(lane_from_int(c), lane_from_int(d), at->s);
    return lane_mix(top, bottom, at->t);
}

// In 65535ths. `texels`: of the texture.
static inline FV4 fetch_level(global const ulong* texels, const LevelLookup* at) {
    Texels a = gather_texels(texels, at->upper_left);
    Texels b = gather_texels(texels, at->upper_right);
    Texels c = gather_texels(texels, at->lower_left);
    Texels d = gather_texels(texels, at->lower_right);
    FV4 out;
    out.x = mix_corners(a.low & 0xffffu, b.low & 0xffffu, c.low & 0xffffu, d.low & 0xffffu, at);
    out.y = mix_corners(a.low >> 16, b.low >> 16, c.low >> 16, d.low >> 16, at);
    out.z = mix_corners(a.high & 0xffffu, b.high & 0xffffu, c.high & 0xffffu, d.high & 0xffffu, at);
    out.w = mix_corners(a.high >> 16, b.high >> 16, c.high >> 16, d.high >> 16, at);
    return out;
}

static inline FV4 scale4(FV4 a, float s) {
    a.x *= s;
    a.y *= s;
    a.z *= s;
    a.w *= s;
    return a;
}

#define TEXEL_UNIT (1.0f / 65535.0f)

// RGBA of a texture, linear.
static inline FV4 fetch_texture(TextureBuffers buffers, global const TextureRow* row,
                                const Lookup* at) {
    global const ulong* texels = buffers.texels + row->first_texel;
    FV4 out = fetch_level(texels, &at->level);
    if (at->two_levels) {
        FV4 coarser = fetch_level(texels, &at->coarser);
        out.x = lane_mix(out.x, coarser.x, at->coarser_share);
        out.y = lane_mix(out.y, coarser.y, at->coarser_share);
        out.z = lane_mix(out.z, coarser.z, at->coarser_share);
        out.w = lane_mix(out.w, coarser.w, at->coarser_share);
    }
    return scale4(out, TEXEL_UNIT);
}

static inline FV fetch_level_alpha(global const ulong* texels, const LevelLookup* at) {
    return mix_corners(gather_texels(texels, at->upper_left).high >> 16,
                       gather_texels(texels, at->upper_right).high >> 16,
                       gather_texels(texels, at->lower_left).high >> 16,
                       gather_texels(texels, at->lower_right).high >> 16, at);
}

// The alpha of fetch_texture().
static inline FV fetch_alpha(TextureBuffers buffers, global const TextureRow* row,
                             const Lookup* at) {
    global const ulong* texels = buffers.texels + row->first_texel;
    FV out = fetch_level_alpha(texels, &at->level);
    if (at->two_levels) {
        out = lane_mix(out, fetch_level_alpha(texels, &at->coarser), at->coarser_share);
    }
    return out * TEXEL_UNIT;
}

// Asks the caches for the texels of a level.
static inline void prefetch_level(global const ulong* texels, const LevelLookup* at) {
#if PREFETCH && VW > 1
    uint upper[VW];
    uint lower[VW];
    lane_store(at->upper_left, upper);
    lane_store(at->lower_left, lower);
#pragma unroll
    for (uint i = 0; i < VW; ++i) {
        prefetch_to_read(texels + upper[i]);
        prefetch_to_read(texels + lower[i]);
    }
#endif
}

static inline void prefetch_texture(TextureBuffers buffers, global const TextureRow* row,
                                    const Lookup* at) {
    global const ulong* texels = buffers.texels + row->first_texel;
    prefetch_level(texels, &at->level);
    if (at->two_levels) prefetch_level(texels, &at->coarser);
}

// Squared lengths of a footprint's sides in texels.
typedef struct Sides {
    FV x2, y2;
} Sides;

static inline Sides sides_of(global const TextureRow* row, Footprint at) {
    FV width = fv((float)row->width);
    FV height = fv((float)row->height);
    FV ux = at.u_dx * width;
    FV vx = at.v_dx * height;
    FV uy = at.u_dy * width;
    FV vy = at.v_dy * height;
    Sides out;
    out.x2 = fma(ux, ux, vx * vx);
    out.y2 = fma(uy, uy, vy * vy);
    return out;
}

// Half of log2, of a length's square.
static inline FV lambda_of(FV length2) { return 0.5f * lane_log2(max(length2, fv(1e-30f))); }

static inline Lookup lookup_isotropic(global const TextureRow* row, Footprint at) {
    Sides sides = sides_of(row, at);
    return make_lookup(row, at.u, at.v, lambda_of(max(sides.x2, sides.y2)));
}

#if MAX_ANISOTROPY > 1
static inline bool is_anisotropic(global const TextureRow* row) {
    return (row->filter & (FILTER_MINIFY_NEAREST | FILTER_NO_MIPMAPS)) == 0u;
}

// Samples along the longer side of a footprint.
typedef struct Samples {
    FV count, weight;
    FV step_u, step_v;  // from one to the next
    FV lambda;
} Samples;

static inline Samples samples_along(global const TextureRow* row, Footprint at) {
    Sides sides = sides_of(row, at);
    MASK along_x = lane_mask(sides.x2 >= sides.y2);
    FV longer = max(sides.x2, sides.y2);
    FV shorter = max(min(sides.x2, sides.y2), fv(1e-30f));
    Samples out;
    out.count = min(max(ceil(lane_sqrt(longer / shorter)), fv(1.0f)), fv((float)MAX_ANISOTROPY));
    out.weight = fv(1.0f) / out.count;
    out.step_u = lane_select(along_x, at.u_dx, at.u_dy) * out.weight;
    out.step_v = lane_select(along_x, at.v_dx, at.v_dy) * out.weight;
    out.lambda = lambda_of(longer * out.weight * out.weight);
    return out;
}

static inline FV4 sample_anisotropic(TextureBuffers buffers, global const TextureRow* row,
                                     Footprint at) {
    Samples s = samples_along(row, at);
    float most = lane_max(s.count);
    FV4 sum;
    sum.x = sum.y = sum.z = sum.w = fv(0.0f);
    for (float i = 0.0f; i < most; i += 1.0f) {
        FV along = fma(s.count, fv(-0.5f), fv(i + 0.5f));
        Lookup tap =
            make_lookup(row, fma(s.step_u, along, at.u), fma(s.step_v, along, at.v), s.lambda);
        FV4 texel = fetch_texture(buffers, row, &tap);
        FV share = lane_select(fv(i) < s.count, s.weight, fv(0.0f));
        sum.x = fma(texel.x, share, sum.x);
        sum.y = fma(texel.y, share, sum.y);
        sum.z = fma(texel.z, share, sum.z);
        sum.w = fma(texel.w, share, sum.w);
    }
    return sum;
}
#endif
#endif
