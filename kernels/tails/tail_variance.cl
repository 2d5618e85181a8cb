// SPDX-License-Identifier: Apache-2.0
// Estimates the variance that random ranges (Tails::stochastic) cause in each pixel's luminance,
// from the lights whose range reaches: X = f / p with probability p, else 0, has E[X^2 (1 - p)].
// Adds it to the estimate of sampled shadows. One work-item does VW pixels, neighbours in the order
// of their tile's clusters.
#define ORDERED_PIXELS 1
#include "kernels/device/lit_item.h"
#include "kernels/device/radiance.h"
#include "kernels/shadows/shadow_bits.h"
#include "kernels/shadows/shadow_pick.h"

// SHADOWS: 0: every light is seen; 1: words have the pixels that see a light. SAMPLED_SHADOWS: the
// words have those that picked it and from which it is hidden.
#ifndef SHADOWS
#define SHADOWS 0
#endif
#ifndef SAMPLED_SHADOWS
#define SAMPLED_SHADOWS 0
#endif

// The seen share of a light that adds `alone`: exact, or an unbiased estimate.
static inline FV seen_share(ShadowPick pick, ShadowBits bits, uint i, FV alone) {
#if SAMPLED_SHADOWS
    FV q = pick_probability(pick, alone);
    return lane_select(sees_light(bits, i), fv(1.0f) - fv(1.0f) / q, fv(1.0f));
#elif SHADOWS
    return lane_select(sees_light(bits, i), fv(1.0f), fv(0.0f));
#else
    return fv(1.0f);
#endif
}

#if SAMPLED_SHADOWS && HAS_AREA_LIGHTS
// The same of a light with a size whose sum alone is `one`: its square is at most that.
static inline FV seen_area_share(ShadowPick pick, ShadowBits bits, uint i, LightSum one,
                                 uint light) {
    FV hidden = fv(0.0f);
    for (uint lobe = 0; lobe < AREA_LOBES; ++lobe, i += lobe_slots(pick.rays)) {
        FV part = light_alone(pick, lobe_part(one, lobe));
        FV pairs = picked_pairs(pick, part, light, lobe);
        FV weight = area_weight(mean_pairs(pick, part), pairs, count_hidden(bits, i, pairs));
        // The square of a denormal part is 0, and its weight no number.
        hidden += lane_select(part > fv(1e-18f), part * weight, fv(0.0f));
    }
    return fv(1.0f) - hidden / max(light_alone(pick, one), fv(1e-30f));
}
#endif

kernel void tail_variance(LIT_ARGS, WORD_ARGS(const), SAMPLE_ARGS,
                          global float* restrict variance) {  // in/out [height][stride]
    BEGIN_ORDERED_ITEM;
    Surface s = load_surface(g, item.pixels, item.z);
    ShadingPoint p = make_shading_point(s, view.orthographic != 0u);
    ShadowPick pick;
#if SAMPLED_SHADOWS
    pick = make_pick(s, p, SAMPLES_OF_ARGS, view, item.pixels, at);
#endif
    pick.surface = s;
    pick.point = p;
    pick.surface.emissive = zero3();
    LightExtras extras = EXTRAS_OF_ARGS;
    bool is_lit = true;
#if SHADOWS
    is_lit = HAS_USABLE_WORDS(at.tile);
#endif
    FV sum = fv(0.0f);
    FOR_EACH_CLUSTER_OF(item, i, mine, active, at.tile) {
        ShadowBits bits;
#if SHADOWS
        bits =
            bits_of_cluster(words + word_offsets[at.tile], clusters + i, place_of_item(at.x, at.y));
#endif
        for (uint j = 0; is_lit && j < clusters[i].list_count; ++j) {
            uint index = lists[clusters[i].list_begin + j];
            ShadeLight light = LIGHT_AT(lights, index);
            if (!has_random_range(light)) continue;
            float4 from = light.position_inv_range2;
            FV3 v = fv3(fv(from.x) - p.position.x, fv(from.y) - p.position.y,
                        fv(from.z) - p.position.z);
            LightSum one = EVALUATE(zero_sum(), p, light, extras, index);
            FV alone = light_alone(pick, one);
            FV missed = fv(1.0f) - fv(1.0f) / random_range_weight(light, dot3(v, v));
            uint place = directional_count + j * light_slots(pick.rays);
            FV share = seen_share(pick, bits, place, alone);
#if SAMPLED_SHADOWS && HAS_AREA_LIGHTS
            LightShape shape = shape_of_light(extras, index);
            if (has_size(shape)) share = seen_area_share(pick, bits, place, one, index);
#endif
            sum += lane_select(mine, alone * alone * missed * share, fv(0.0f));
        }
    }
    store_plane(variance, item.pixels,
                lane_select(item.shown, LOAD_PLANE(FV, variance, item.pixels) + sum, fv(0.0f)));
}
