// SPDX-License-Identifier: Apache-2.0
// Textures at VW pixels, for OpenCL C and GLSL: mip-mapped linear filtering as OpenGL 4.5 (8.14)
// states it, without its freedoms; host/measure/reference/texture_sampler.h is the same in double.
//
// A Lookup, the places where a pixel reads, is apart from the texels: a material's textures of one
// size and wrapping share it. Places are relative to a texture's first texel.
//
// Each language defines before (kernels/device/texture.h, raster/shaders/scene.glsl):
//   Map                          what a use of a material reads
//   TEXTURE_ROW(map)             its row
//   level_offsets(map, levels)   TextureRow::level_offset of each lane's level
//   fetch_texels(map, places)    Texels at places from its first texel on
//
// Compile-time switches, each 1 where some texture of the scene needs it: HAS_NEAREST (filters
// other than linear between texels and levels), HAS_WRAPS (other than repeat), HAS_UV_TRANSFORM.
// MAX_ANISOTROPY > 1: up to so many samples along the longer side of the pixel's footprint, whose
// mip level is that of the side's share (EXT_texture_filter_anisotropic).
#ifndef KILOLUX_SHARED_TEXTURE_H
#define KILOLUX_SHARED_TEXTURE_H
#include "kernels/shared/surface_scene.h"

#ifndef MAX_ANISOTROPY
#define MAX_ANISOTROPY 1
#endif

// Coordinates in a texture and their change to the right and lower neighbour pixel.
SHARED_PLAIN_STRUCT(Footprint) {
    FV u, v;
    FV u_dx, v_dx, u_dy, v_dy;
};

// The four texels about a point of a mip level, and the point's place between them.
SHARED_PLAIN_STRUCT(LevelLookup) {
    UV upper_left, upper_right, lower_left, lower_right;  // from the texture's first texel on
    FV s, t;
};

// The texels that a point reads.
SHARED_PLAIN_STRUCT(Lookup) {
    LevelLookup level;
    LevelLookup coarser;
    FV coarser_share;
    bool two_levels;  // else coarser_share is 0 in all lanes
};

// log2 of x > 0, absolute error 4e-7: the exponent, and a minimax polynomial of the mantissa. Only
// products and sums, so that every device gets the same bits.
SHARED_FN FV lane_log2(FV x) {
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
SHARED_PLAIN_STRUCT(Taps) {
    UV first, second;
    FV share;
};

#if HAS_WRAPS
// A coordinate in [0, 1], where `wrap` is not to repeat: texels beyond the edges are not read.
SHARED_FN FV within_edges(FV coordinate, uint wrap) {
    if (wrap == WRAP_CLAMP) return min(max(coordinate, fv(0.0f)), fv(1.0f));
    FV twice = coordinate - 2.0f * floor(0.5f * coordinate);
    return lane_select(twice > fv(1.0f), 2.0f - twice, twice);
}
#endif

// Of `size` texels; `nearest`: 1 where one texel is wanted, else 0.
SHARED_FN Taps taps_of(FV coordinate, UV size, uint wrap, FV nearest) {
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
    UV first = lane_select_uint(before, last, place);
    MASK after = lane_mask(first >= last);
    UV second = lane_select_uint(after, lane_uint(0u), first + 1u);
#if HAS_WRAPS
    if (wrap != WRAP_REPEAT) {
        first = lane_select_uint(before, lane_uint(0u), place);
        second = min(place + 1u, last);
    }
#endif
    Taps result;
    // A coordinate that is not a number must stay inside, too.
    result.first = min(first, last);
    result.second = min(second, last);
    result.share = at - whole;
#if HAS_NEAREST
    result.share *= 1.0f - nearest;
#endif
    return result;
}

// The texels about (u, v) in the mip levels `level`.
SHARED_FN LevelLookup lookup_level(Map map, UV level, FV u, FV v, FV nearest) {
    UV width = max(lane_uint(TEXTURE_ROW(map).width) >> level, lane_uint(1u));
    UV height = max(lane_uint(TEXTURE_ROW(map).height) >> level, lane_uint(1u));
    Taps s = taps_of(u, width, TEXTURE_ROW(map).wrap_s, nearest);
    Taps t = taps_of(v, height, TEXTURE_ROW(map).wrap_t, nearest);
    UV first = level_offsets(map, level);
    UV top = first + t.first * width;
    UV bottom = first + t.second * width;
    LevelLookup result;
    result.upper_left = top + s.first;
    result.upper_right = top + s.second;
    result.lower_left = bottom + s.first;
    result.lower_right = bottom + s.second;
    result.s = s.share;
    result.t = t.share;
    return result;
}

// The texels about (u, v); lambda: log2 of the footprint in texels.
SHARED_FN Lookup make_lookup(Map map, FV u, FV v, FV lambda) {
    FV level = min(max(lambda, fv(0.0f)), fv(float_of(TEXTURE_ROW(map).levels - 1u)));
    FV nearest = fv(0.0f);
#if HAS_NEAREST
    MASK magnified = lane_mask(!(lambda > fv(0.0f)));
    uint filters = TEXTURE_ROW(map).filters;
    FV magnify = fv((filters & FILTER_MAGNIFY_NEAREST) != 0u ? 1.0f : 0.0f);
    FV minify = fv((filters & FILTER_MINIFY_NEAREST) != 0u ? 1.0f : 0.0f);
    nearest = lane_select(magnified, magnify, minify);
    if ((filters & FILTER_NO_MIPMAPS) != 0u) level = fv(0.0f);
    if ((filters & FILTER_NEAREST_MIPMAP) != 0u) {
        level = lane_select(magnified, fv(0.0f), ceil(level + 0.5f) - 1.0f);
    }
#endif
    FV finer = floor(level);
    UV number = lane_to_uint(finer);
    Lookup result;
    result.coarser_share = level - finer;
    result.two_levels = lane_any(lane_mask(result.coarser_share > fv(0.0f)));
    result.level = lookup_level(map, number, u, v, nearest);
    result.coarser = result.level;
    if (result.two_levels) {
        UV next = min(number + 1u, lane_uint(TEXTURE_ROW(map).levels - 1u));
        result.coarser = lookup_level(map, next, u, v, nearest);
    }
    return result;
}

SHARED_FN FV lane_mix(FV a, FV b, FV share) { return fma(share, b - a, a); }

SHARED_FN FV mix_corners(UV a, UV b, UV c, UV d, IN(LevelLookup) at) {
    FV top = lane_mix(lane_from_int(a), lane_from_int(b), AT(at).s);
    FV bottom = lane_mix(lane_from_int(c), lane_from_int(d), AT(at).s);
    return lane_mix(top, bottom, AT(at).t);
}

// RGBA of a mip level, times 65535.
SHARED_FN FV4 fetch_level(Map map, IN(LevelLookup) at) {
    Texels a = fetch_texels(map, AT(at).upper_left);
    Texels b = fetch_texels(map, AT(at).upper_right);
    Texels c = fetch_texels(map, AT(at).lower_left);
    Texels d = fetch_texels(map, AT(at).lower_right);
    FV4 result;
    result.x = mix_corners(a.low & 0xffffu, b.low & 0xffffu, c.low & 0xffffu, d.low & 0xffffu, at);
    result.y = mix_corners(a.low >> 16, b.low >> 16, c.low >> 16, d.low >> 16, at);
    result.z =
        mix_corners(a.high & 0xffffu, b.high & 0xffffu, c.high & 0xffffu, d.high & 0xffffu, at);
    result.w = mix_corners(a.high >> 16, b.high >> 16, c.high >> 16, d.high >> 16, at);
    return result;
}

SHARED_FN FV4 scale4(FV4 a, float s) {
    a.x *= s;
    a.y *= s;
    a.z *= s;
    a.w *= s;
    return a;
}

#define TEXEL_UNIT (1.0f / 65535.0f)

// RGBA of a texture, linear.
SHARED_FN FV4 fetch_map(Map map, IN(Lookup) at) {
    FV4 result = fetch_level(map, REF(AT(at).level));
    if (AT(at).two_levels) {
        FV4 coarser = fetch_level(map, REF(AT(at).coarser));
        result.x = lane_mix(result.x, coarser.x, AT(at).coarser_share);
        result.y = lane_mix(result.y, coarser.y, AT(at).coarser_share);
        result.z = lane_mix(result.z, coarser.z, AT(at).coarser_share);
        result.w = lane_mix(result.w, coarser.w, AT(at).coarser_share);
    }
    return scale4(result, TEXEL_UNIT);
}

SHARED_FN FV fetch_level_alpha(Map map, IN(LevelLookup) at) {
    return mix_corners(fetch_texels(map, AT(at).upper_left).high >> 16,
                       fetch_texels(map, AT(at).upper_right).high >> 16,
                       fetch_texels(map, AT(at).lower_left).high >> 16,
                       fetch_texels(map, AT(at).lower_right).high >> 16, at);
}

// The alpha of fetch_map().
SHARED_FN FV fetch_alpha(Map map, IN(Lookup) at) {
    FV result = fetch_level_alpha(map, REF(AT(at).level));
    if (AT(at).two_levels) {
        result =
            lane_mix(result, fetch_level_alpha(map, REF(AT(at).coarser)), AT(at).coarser_share);
    }
    return result * TEXEL_UNIT;
}

// Squared lengths of a footprint's sides in texels.
SHARED_PLAIN_STRUCT(Sides) { FV x2, y2; };

SHARED_FN Sides sides_of(Map map, Footprint at) {
    FV width = fv(float_of(TEXTURE_ROW(map).width));
    FV height = fv(float_of(TEXTURE_ROW(map).height));
    FV ux = at.u_dx * width;
    FV vx = at.v_dx * height;
    FV uy = at.u_dy * width;
    FV vy = at.v_dy * height;
    Sides result;
    result.x2 = fma(ux, ux, vx * vx);
    result.y2 = fma(uy, uy, vy * vy);
    return result;
}

// log2 of a length, from its square.
SHARED_FN FV lambda_of(FV length2) { return 0.5f * lane_log2(max(length2, fv(1e-30f))); }

SHARED_FN Lookup lookup_isotropic(Map map, Footprint at) {
    Sides sides = sides_of(map, at);
    return make_lookup(map, at.u, at.v, lambda_of(max(sides.x2, sides.y2)));
}

#if MAX_ANISOTROPY > 1
SHARED_FN bool is_anisotropic(Map map) {
    return (TEXTURE_ROW(map).filters & (FILTER_MINIFY_NEAREST | FILTER_NO_MIPMAPS)) == 0u;
}

// Samples along the longer side of a footprint.
SHARED_PLAIN_STRUCT(Samples) {
    FV count, weight;
    FV step_u, step_v;  // from one to the next
    FV lambda;
};

SHARED_FN Samples samples_along(Map map, Footprint at) {
    Sides sides = sides_of(map, at);
    MASK along_x = lane_mask(sides.x2 >= sides.y2);
    FV longer = max(sides.x2, sides.y2);
    FV shorter = max(min(sides.x2, sides.y2), fv(1e-30f));
    Samples result;
    result.count =
        min(max(ceil(lane_sqrt(longer / shorter)), fv(1.0f)), fv(float_of(MAX_ANISOTROPY)));
    result.weight = fv(1.0f) / result.count;
    result.step_u = lane_select(along_x, at.u_dx, at.u_dy) * result.weight;
    result.step_v = lane_select(along_x, at.v_dx, at.v_dy) * result.weight;
    result.lambda = lambda_of(longer * result.weight * result.weight);
    return result;
}

SHARED_FN FV4 sample_anisotropic(Map map, Footprint at) {
    Samples s = samples_along(map, at);
    float most = lane_max(s.count);
    FV4 sum;
    sum.x = sum.y = sum.z = sum.w = fv(0.0f);
    for (float i = 0.0f; i < most; i += 1.0f) {
        FV along = fma(s.count, fv(-0.5f), fv(i + 0.5f));
        Lookup tap =
            make_lookup(map, fma(s.step_u, along, at.u), fma(s.step_v, along, at.v), s.lambda);
        FV4 texel = fetch_map(map, REF(tap));
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
