// SPDX-License-Identifier: Apache-2.0
// Sampled shadows: the hidden light of the picked lights, which the estimate takes from the sum of
// all, and its variance.
#ifndef KILOLUX_DEVICE_HIDDEN_LIGHTS_H
#define KILOLUX_DEVICE_HIDDEN_LIGHTS_H
#include "kernels/shading/seen_lights.h"

#if SAMPLED_SHADOWS
#if SHADOWS == SHADOWS_BITS
// The lanes that pick the light and from which it is hidden, as cast_shadows' bits say.
static inline MASK hides_drawn(LightSet set, uint entry, uint light) {
    bool is_listed = (light & PICKED_DIRECTIONAL) == 0u;
    return sees_light(set.shadows, is_listed ? place_of_entry(set, entry) : entry);
}
#else
// The same; `one`: the light's sum alone.
static inline MASK hides_drawn(LightSet set, uint entry, uint light, LightSum one) {
    MASK picked = set.shadows.wanted & picks_light(set.pick, light_alone(set.pick, one), light);
    if (!lane_any(picked)) return picked;
    set.shadows.wanted = picked;
    MASK seen = (light & PICKED_DIRECTIONAL) != 0u ? sees_directional(set, entry)
                                                   : sees_entry(set, entry, light);
    return picked & ~seen;
}
#endif

// `sum`, the hidden light of the estimate, with a light whose sum alone is `one`.
static inline LightSum sampled_sum(LightSet set, MASK hidden, LightSum one, LightSum sum) {
    FV alone = light_alone(set.pick, one);
    FV q = pick_probability(set.pick, alone);
    *set.variance += lane_select(hidden, variance_of(alone, q), fv(0.0f));
    return add_hidden(sum, one, q, hidden);
}

#if AREA_SHADOWS
static inline bool is_area(LightSet set, uint light) {
    if ((light & PICKED_DIRECTIONAL) != 0u) return false;
    return has_size(shape_of_light(set.extras, light));
}

// Hidden rays of a lobe of a light with a size that picks `pairs`.
static inline HiddenRays hidden_rays(LightSet set, uint entry, uint light, uint lobe, FV pairs) {
    uint first = lobe * lobe_slots(set.pick.rays);
#if SHADOWS == SHADOWS_BITS
    return count_hidden(set.shadows, place_of_entry(set, entry) + first, pairs);
#else
    HiddenRays out = {fv(0.0f), fv(0.0f)};
    ShadowView view = set.shadows.scene.view;
    ShadeLight row = LIGHT_AT(set.lights, light);
    ShadowLight target =
        with_shape(shadow_point_light(view, row), view, row.position_inv_range2,
                   shape_of_light(set.extras, light), light_key(set.pick.tile, light));
    MASK mine = set.shadows.wanted;
    for (uint slot = 0; lane_any(mine & casts_slot(pairs, slot)); ++slot) {
        target.area = at_slot(target.area, first + slot, set.pick.rays);
        set.shadows.wanted = mine & casts_slot(pairs, slot);
        out = add_hidden_ray(out, slot, set.shadows.wanted & ~sees(set.shadows, target));
    }
    return out;
#endif
}

// sampled_sum() of a light with a size.
static inline LightSum sampled_area(LightSet set, uint entry, uint light, LightSum one,
                                    LightSum sum) {
    for (uint lobe = 0; lobe < AREA_LOBES; ++lobe) {
        LightSum part = lobe_part(one, lobe);
        FV alone = light_alone(set.pick, part);
        FV y = mean_pairs(set.pick, alone);
        FV pairs = picked_pairs(set.pick, alone, light, lobe);
        HiddenRays hidden = hidden_rays(set, entry, light, lobe, pairs);
        MASK any = lane_mask(hidden.first + hidden.second > fv(0.0f));
        if (!lane_any(any)) continue;
        *set.variance += lane_select(any, area_variance(alone, y, pairs, hidden), fv(0.0f));
        FV weight = lane_select(any, area_weight(y, pairs, hidden), fv(0.0f));
        sum = add_weighted(sum, weight, part);
    }
    return sum;
}

#if SHADOWS == SHADOWS_BITS
// Whether any ray to the light is hidden; only then its sum is needed.
static inline bool hides_any(LightSet set, uint entry) {
    uint first = place_of_entry(set, entry), slots = lobe_slots(set.pick.rays);
    uint bits = 0u;
    for (uint lobe = 0; lobe < AREA_LOBES; ++lobe) {
        uint candidates = word_of_lanes(set.shadows, first + light_ray_slots(set.pick.rays) + lobe);
        if ((candidates & lane_ballot((MASK)(-1))) == 0u) continue;
        for (uint slot = lobe * slots; slot < (lobe + 1u) * slots; ++slot) {
            bits |= word_of_lanes(set.shadows, first + slot);
        }
    }
    return (bits & lane_ballot((MASK)(-1))) != 0u;
}
#else
#define hides_any(set, entry) true
#endif
#define ADD_AREA(set, entry, light, sum, ONE)                                           \
    if (is_area(set, light)) {                                                          \
        if (hides_any(set, entry)) (sum) = sampled_area(set, entry, light, (ONE), sum); \
    } else
#else
#define ADD_AREA(set, entry, light, sum, ONE)
#endif

// Adds a light that is hidden, which the estimate takes from the radiance if all are seen. ONE: its
// sum alone, which bits need only where one is set.
#if SHADOWS == SHADOWS_BITS
#define ADD_ALONE(set, entry, light, sum, ONE)                              \
    ADD_AREA(set, entry, light, sum, ONE) {                                 \
        MASK hidden = hides_drawn(set, entry, light);                       \
        if (lane_any(hidden)) (sum) = sampled_sum(set, hidden, (ONE), sum); \
    }
#else
#define ADD_ALONE(set, entry, light, sum, ONE)                            \
    ADD_AREA(set, entry, light, sum, ONE) {                               \
        LightSum one = (ONE);                                             \
        MASK hidden = hides_drawn(set, entry, light, one);                \
        if (lane_any(hidden)) (sum) = sampled_sum(set, hidden, one, sum); \
    }
#endif
#if LIGHT_GROUPS
// The light alone, so that its variance counts once; terms are added with the same bits.
#define ADD_SAMPLED(set, entry, light, sum, group, ONE)                      \
    {                                                                        \
        LightSum taken = zero_sum();                                         \
        ADD_ALONE(set, entry, light, taken, ONE)                             \
        (sum) = add_sums(sum, taken);                                        \
        if ((group) != 0u) join_group(set, group, (MASK)(-1), WHITE, taken); \
    }
#else
#define ADD_SAMPLED(set, entry, light, sum, group, ONE) ADD_ALONE(set, entry, light, sum, ONE)
#endif
#endif
#endif
