// SPDX-License-Identifier: Apache-2.0
// Which lobes of lights with a size a pixel may pick: marked while all lights are summed, so that
// draw_shadows need not evaluate the others.
//
// A lobe is picked where its pairs y = n |f| / (2 |U|) (shadow_pick.h) and its random number r make
// y + r >= 1. |U| is known when all lights are summed, but it is at least S, the sum of |f| over
// the lights so far: no light takes light away. So n |f| >= 2 (1 - r) S is necessary. Of k lights
// alike the i-th meets it with probability n / (2 i), so about n log(k) / 2 lobes are marked where
// n / 2 are picked.
//
// |f| is what the light added to its block of the sum, off by the rounding of that block: a few
// 2^-24 of S. CANDIDATE_SLACK grants 30 times that.
#ifndef KILOLUX_DEVICE_SHADOW_CANDIDATES_H
#define KILOLUX_DEVICE_SHADOW_CANDIDATES_H
#include "kernels/shadows/shadow_bits.h"
#include "kernels/shadows/shadow_pick.h"

// For each of n + 4.
#define CANDIDATE_SLACK 4e-6f

#ifndef MARK_CANDIDATES
#define MARK_CANDIDATES 0
#endif
#if MARK_CANDIDATES
typedef struct Candidates {
    LightSum per_term;   // luminance of the reflected radiance for each unit of the sums' channels
    ShadowBits bits;     // of the work-item in its cluster
    MASK mine;           // its lanes in the cluster
    global uint* words;  // of the picture
    uint tile;           // tile_key()
    float rays;          // n
    uint directional_count;
} Candidates;

// Luminance that the surface reflects for a unit of each channel.
static inline LightSum luminance_per_term(Surface s, ShadingPoint p) {
    const FV3 unit[3] = {fv3(fv(1.0f), fv(0.0f), fv(0.0f)), fv3(fv(0.0f), fv(1.0f), fv(0.0f)),
                         fv3(fv(0.0f), fv(0.0f), fv(1.0f))};
    LightSum out = zero_sum();
#define TERM_LUMINANCE(has, term)                                  \
    if (has) {                                                     \
        FV channel[3];                                             \
        for (uint i = 0; i < 3u; ++i) {                            \
            LightSum one = zero_sum();                             \
            one.term = unit[i];                                    \
            channel[i] = luminance(reflected_radiance(s, p, one)); \
        }                                                          \
        out.term = fv3(channel[0], channel[1], channel[2]);        \
    }
    LIGHT_TERMS(TERM_LUMINANCE)
    return out;
}

// Marks the lanes that may pick a light with a size, the j-th of its list, which has just been
// added to a sum. `sum`: of |f| over the lights so far; grows.
static inline void mark_candidates(Candidates of, LightExtras extras, uint j, uint light,
                                   LightSum before, LightSum after, FV* sum) {
    FV alone[AREA_LOBES];
    alone[0] = dot3(of.per_term.diffuse, sub3(after.diffuse, before.diffuse));
#if AREA_LOBES > 1u
    alone[1] = dot3(of.per_term.specular, sub3(after.specular, before.specular));
    *sum += alone[0] + alone[1];
#else
    *sum += alone[0];
#endif
    if (!has_size(shape_of_light(extras, light))) return;
    uint key = light_key(of.tile, light);
    uint first = of.directional_count + j * light_slots(of.rays) + light_ray_slots(of.rays);
    for (uint lobe = 0; lobe < AREA_LOBES; ++lobe) {
        float missing = 1.0f - random_of(lobe_key(key, lobe));
        float slack = CANDIDATE_SLACK * (of.rays + 4.0f);
        MASK may = lane_mask(alone[lobe] * (0.5f * of.rays) >= *sum * (missing - slack));
        // Where nothing is added, nothing is picked but by rounding.
        if (missing > slack) may &= lane_mask(alone[lobe] > fv(0.0f));
        put_bits(of.bits, first + lobe, of.mine & may, of.words);
    }
}
#endif
#endif
