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
//
// The lobes of a light with a size, diffuse and glossy, are picked as if they were two lights, each
// with y = n |f| / (2 |U|) pairs of rays on average: floor(y + r) pairs, r the random number. Each
// ray goes to a point of the light whose density is in proportion to what the lobe reflects, so the
// share of hidden rays estimates the hidden share of f without bias, and exactly where all or none
// of the light is hidden. The glossy lobe is that of the base; sheen and coat share its rays. With
// the shares a and b of the first and the second rays of the pairs and q = min(1, y), (a + b) / (2
// q) of f is taken away, whose variance ((a + b)^2 / (4 q^2) - a b / q) f^2 estimates without bias,
// since a and b are independent.
#ifndef KILOLUX_DEVICE_SHADOW_PICK_H
#define KILOLUX_DEVICE_SHADOW_PICK_H
#include "kernels/device/gbuffer.h"
#include "kernels/device/luminance.h"
#include "kernels/device/radiance.h"
#include "kernels/shadows/shadow_bits.h"
#include "kernels/shadows/shadow_random.h"
#include "kernels/shared/evaluate.h"

// Number of a directional light among all that are picked.
#define PICKED_DIRECTIONAL 0x80000000u

// The inputs by which a work-item's pixels pick lights.
typedef struct ShadowPick {
    Surface surface;
    ShadingPoint point;
    FV whole;    // luminance of the radiance if all lights are seen
    float rays;  // n
    uint tile;   // tile_key()
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
    out.tile = tile_key(view, samples.seed, at.x, at.y);
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
    float random = random_of(light_key(pick.tile, light));
    return lane_mask(max(pick.whole, fv(1e-30f)) * random < alone * pick.rays);
}

// The part of a light's sum of one of its lobes.
static inline LightSum lobe_part(LightSum one, uint lobe) {
#if AREA_LOBES > 1u
    if (lobe == 0u) one.specular = zero3();
    if (lobe != 0u) one.diffuse = zero3();
#endif
    return one;
}

// Pairs of rays to a light with a size on average, y, and those that are picked.
static inline FV mean_pairs(ShadowPick pick, FV alone) {
    float most = (float)(lobe_slots(pick.rays) / 2u);
    return min(alone * pick.rays * 0.5f / max(pick.whole, fv(1e-30f)), fv(most));
}

static inline FV picked_pairs(ShadowPick pick, FV alone, uint light, uint lobe) {
    float random = random_of(lobe_key(light_key(pick.tile, light), lobe));
    float most = (float)(lobe_slots(pick.rays) / 2u);
    return min(floor(mean_pairs(pick, alone) + random), fv(most));
}

// The lanes that cast the ray of a slot.
static inline MASK casts_slot(FV pairs, uint slot) {
    return lane_mask(pairs > fv((float)(slot / 2u)));
}

// Hidden rays of the first and of the second ones of pairs.
typedef struct HiddenRays {
    FV first, second;
} HiddenRays;

static inline HiddenRays add_hidden_ray(HiddenRays sum, uint slot, MASK hidden) {
    FV one = lane_select(hidden, fv(1.0f), fv(0.0f));
    if ((slot & 1u) == 0u) sum.first += one;
    if ((slot & 1u) != 0u) sum.second += one;
    return sum;
}

// Those of a light whose slots' bits, from word `first` on, say which rays are hidden.
static inline HiddenRays count_hidden(ShadowBits bits, uint first, FV pairs) {
    HiddenRays out = {fv(0.0f), fv(0.0f)};
    for (uint slot = 0; lane_any(casts_slot(pairs, slot)); ++slot) {
        MASK hidden = sees_light(bits, first + slot) & casts_slot(pairs, slot);
        out = add_hidden_ray(out, slot, hidden);
    }
    return out;
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

// The same of a light with a size, and its weight in what the estimate takes away.
static inline FV area_variance(FV light, FV y, FV pairs, HiddenRays hidden) {
    FV q = min(y, fv(1.0f));
    FV a = hidden.first / max(pairs, fv(1.0f)), b = hidden.second / max(pairs, fv(1.0f));
    FV mean = fv(0.5f) * (a + b) / q;
    return light * light * (mean * mean - a * b / q);
}

static inline FV area_weight(FV y, FV pairs, HiddenRays hidden) {
    FV q = min(y, fv(1.0f));
    return (hidden.first + hidden.second) / (max(pairs, fv(1.0f)) * fv(2.0f) * q);
}
#endif
