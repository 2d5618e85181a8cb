// SPDX-License-Identifier: Apache-2.0
// Sampled shadows: which lights' rays a pixel draws, and what their sum then is.
//
// Let f be what a light adds to a pixel if it is seen, U the pixel's radiance if all are. A light
// is drawn with probability q = min(1, n |f| / |U|), |.| the luminance, so that n rays are drawn at
// most on average. A drawn light that is hidden takes f / q away from U. That is unbiased for any
// q, and exactly U where nothing is hidden; its variance is the sum of f^2 (1 - q) / q over hidden
// lights, of which the drawn ones give an unbiased estimate, f^2 (1 - q) / q^2 each. One random
// number serves a light in a fine tile, so that its pixels draw the same lights and one walk casts
// their rays: errors of neighbours go together, each pixel's mean is right all the same.
#ifndef KILOLUX_DEVICE_SHADOW_DRAW_H
#define KILOLUX_DEVICE_SHADOW_DRAW_H
#include "kernels/device/gbuffer.h"
#include "kernels/shared/evaluate.h"

// Number of a directional light among all that are drawn.
#define DRAWN_DIRECTIONAL 0x80000000u

// In [0, 1), of 24 bits: a hash of (fine tile of the picture, light, seed); Jarzynski and Olano
// 2020, "Hash Functions for GPU Rendering", pcg4d.
static inline float random_of(uint tile_x, uint tile_y, uint light, uint seed) {
    uint4 v = (uint4)(tile_x, tile_y, light, seed) * 1664525u + 1013904223u;
    for (uint i = 0; i < 2; ++i) {
        v.x += v.y * v.w;
        v.y += v.z * v.x;
        v.z += v.x * v.y;
        v.w += v.y * v.z;
        if (i == 0u) v ^= v >> 16;
    }
    return (float)(v.x >> 8) * (1.0f / 16777216.0f);
}

// What a work-item's pixels draw by.
typedef struct ShadowDraw {
    Surface surface;  // without its own light
    FV whole;         // luminance of the radiance if all lights are seen
    float rays;       // n
    uint tile_x, tile_y, seed;
} ShadowDraw;

static inline FV luminance(FV3 c) {
    return fma(c.z, fv(0.0722f), fma(c.y, fv(0.7152f), c.x * 0.2126f));
}

static inline ShadowDraw make_draw(Surface s, FV3 radiance, float rays, uint tile_x, uint tile_y,
                                   uint seed) {
    ShadowDraw out;
    out.surface = s;
    out.surface.emissive = zero3();
    out.whole = luminance(radiance);
    out.rays = rays;
    out.tile_x = tile_x;
    out.tile_y = tile_y;
    out.seed = seed;
    return out;
}

// |f| of a light whose sum alone is `one`.
static inline FV light_alone(ShadowDraw draw, LightSum one) {
    return luminance(finish_shading(draw.surface, one, 0.0f));
}

static inline FV draw_probability(ShadowDraw draw, FV light) {
    return min(light * draw.rays / max(draw.whole, fv(1e-30f)), fv(1.0f));
}

static inline MASK draws_light(ShadowDraw draw, FV probability, uint light) {
    return lane_mask(fv(random_of(draw.tile_x, draw.tile_y, light, draw.seed)) < probability);
}

// `sum` with a light of which `one` is the sum alone, where a hidden light was drawn.
static inline LightSum add_hidden(LightSum sum, LightSum one, FV probability) {
    FV weight = fv(1.0f) - fv(1.0f) / probability;
    sum.diffuse = add3(sum.diffuse, scale3(one.diffuse, weight));
#if SHADING != SHADING_LAMBERT
    sum.specular = add3(sum.specular, scale3(one.specular, weight));
#endif
    return sum;
}

// What a hidden light that was drawn adds to the estimate of the variance of the luminance.
static inline FV variance_of(FV light, FV probability) {
    FV over = light / probability;
    return over * over * (fv(1.0f) - probability);
}
#endif
