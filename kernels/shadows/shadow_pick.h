// SPDX-License-Identifier: Apache-2.0
// Sampled shadows: which lights a pixel picks rays to, and the estimate of its radiance from them.
//
// Let f be what a light adds to a pixel if it is seen, U the pixel's radiance if all are. A light
// is picked with probability q = min(1, n |f| / |U|), |.| the luminance, so that n rays are picked
// at most on average. A picked light that is hidden takes f / q away from U. That is unbiased for
// any q, and exactly U where nothing is hidden; where all lights are picked it is the exact value
// within 2^-20 of U. Its variance is the sum of f^2 (1 - q) / q over hidden lights, of which the
// picked ones give an unbiased estimate, f^2 (1 - q) / q^2 each. One random number serves a light
// in a fine tile, so that its pixels pick the same lights and one walk casts their rays: errors of
// neighbours go together, each pixel's mean is right all the same.
#ifndef KILOLUX_DEVICE_SHADOW_PICK_H
#define KILOLUX_DEVICE_SHADOW_PICK_H
#include "kernels/device/gbuffer.h"
#include "kernels/device/luminance.h"
#include "kernels/device/radiance.h"
#include "kernels/shared/evaluate.h"
#include "kernels/shared/hash.h"

// Number of a directional light among all that are picked.
#define PICKED_DIRECTIONAL 0x80000000u

// The inputs by which a work-item's pixels pick lights.
typedef struct ShadowPick {
    Surface surface;
    ShadingPoint point;
    FV whole;    // luminance of the radiance if all lights are seen
    float rays;  // n
    uint tile;   // a hash of the fine tile of the picture, and the seed
} ShadowPick;

// SAMPLE_ARGS.
typedef struct ShadowSamples {
    global const float* whole;
    float rays;
    uint seed;
} ShadowSamples;
#define SAMPLES_OF_ARGS ((ShadowSamples){whole, rays, seed})

// The inputs of the pixels of the work-item at `at`.
static inline ShadowPick make_pick(Surface s, ShadingPoint p, ShadowSamples samples, View view,
                                   Pixels pixels, ItemPlace at) {
    ShadowPick out;
    out.surface = s;
    out.point = p;
    out.whole = luminance(load_radiance(samples.whole, view, pixels));
    out.rays = samples.rays;
    uint tile_x = picture_column(view, at.x) / FINE_TILE;
    uint tile_y = picture_row(view, at.y) / FINE_TILE;
    out.tile = hash_of(hash_of(hash_of(samples.seed) ^ tile_x) ^ tile_y);
    return out;
}

// |f| of a light whose sum alone is `one`.
static inline FV light_alone(ShadowPick pick, LightSum one) {
    return luminance(reflected_radiance(pick.surface, pick.point, one));
}

static inline FV pick_probability(ShadowPick pick, FV light) {
    return min(light * pick.rays / max(pick.whole, fv(1e-30f)), fv(1.0f));
}

// The lanes whose probability of picking a light, which alone adds `alone`, is above the light's
// random number in the tile, which is in [0, 1).
static inline MASK picks_light(ShadowPick pick, FV alone, uint light) {
    float random = random_of(hash_of(light ^ pick.tile));
    return lane_mask(max(pick.whole, fv(1e-30f)) * random < alone * pick.rays);
}

// Adds a picked, hidden light to the light that the estimate takes away. `one`: the light's sum
// alone.
static inline LightSum add_hidden(LightSum sum, LightSum one, FV probability, MASK hidden) {
    return add_weighted(sum, lane_select(hidden, fv(1.0f) / probability, fv(0.0f)), one);
}

// The estimate: the radiance if all lights are seen without that of the sum `hidden`.
static inline FV3 without_hidden(ShadowPick pick, FV3 whole, LightSum hidden) {
    return sub3(whole, reflected_radiance(pick.surface, pick.point, hidden));
}

// The term of a picked, hidden light in the estimated variance of the luminance.
static inline FV variance_of(FV light, FV probability) {
    FV over = light / probability;
    return over * over * (fv(1.0f) - probability);
}
#endif
