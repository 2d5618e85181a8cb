// SPDX-License-Identifier: Apache-2.0
// The sum of evaluate() over a list of lights, or with ALL_LIGHTS over lights 0 .. count - 1, for
// VW pixels. With STAGE > 0 a work-group reads that many lights at a time into local memory, which
// GPUs read faster than global memory through its cache. With LIGHT_GROUPS each light also joins
// the sum of its group.
#ifndef KILOLUX_DEVICE_SUM_LIGHTS_H
#define KILOLUX_DEVICE_SUM_LIGHTS_H
#include "kernels/device/light_index.h"
#include "kernels/device/radiance.h"
#include "kernels/device/stored_light.h"
#include "kernels/shared/evaluate.h"

// Which pixels see a light: SHADOWS_NONE: all; SHADOWS_BITS: those whose bit cast_shadows has set;
// SHADOWS_RAYS: those whose rays, cast on demand, reach it. SAMPLED_SHADOWS: only for picked
// lights. TINTED_SHADOWS: surfaces that blend or transmit attenuate the light that is not hidden;
// not with SAMPLED_SHADOWS.
#define SHADOWS_NONE 0
#define SHADOWS_BITS 1
#define SHADOWS_RAYS 2
#ifndef SAMPLED_SHADOWS
#define SAMPLED_SHADOWS 0
#endif
#ifndef SHADOWS
#define SHADOWS SHADOWS_NONE
#endif
#ifndef TINTED_SHADOWS
#define TINTED_SHADOWS 0
#endif
#define AREA_SHADOWS (SAMPLED_SHADOWS && HAS_AREA_LIGHTS)
#if SHADOWS == SHADOWS_BITS
#include "kernels/shadows/shadow_bits.h"
#endif
#if SHADOWS == SHADOWS_RAYS || TINTED_SHADOWS
#include "kernels/shadows/shadow_rays.h"
#endif
#include "kernels/shadows/shadow_candidates.h"
#include "kernels/shadows/shadow_pick.h"

#ifndef ALL_LIGHTS
#define ALL_LIGHTS 0
#endif
#ifndef STAGE
#define STAGE 0
#endif
#ifndef HAS_DIRECTIONAL_LIGHTS
#define HAS_DIRECTIONAL_LIGHTS 0
#endif

typedef struct LightSet {
    global const StoredLight* lights;
#if STAGE > 0
    local ShadeLight* staged;    // [STAGE]
    local uint* staged_indices;  // [STAGE]
#endif
#if SHADOWS == SHADOWS_BITS
    ShadowBits shadows;
    uint directional_count;
#elif SHADOWS == SHADOWS_RAYS
    ShadowRays shadows;
#endif
#if SHADOWS == SHADOWS_RAYS || TINTED_SHADOWS
    global const DirectionalLight* directional;
#endif
#if TINTED_SHADOWS
    ShadowRays tints;  // of a tinting_scene()
#endif
#if SAMPLED_SHADOWS
    ShadowPick pick;
    FV* variance;  // the estimated variance of the luminance
#endif
#if MARK_CANDIDATES
    Candidates candidates;
#endif
#if LIGHT_GROUPS
    LightSum* groups;        // [1 + LIGHT_GROUPS]; 0: of the lights in no group
    uint first_directional;  // place of the directional lights in extras.groups
    MASK mine;               // lanes of the cluster: only they add to `groups`
#endif
    LightExtras extras;
} LightSet;

// Declares the set of a kernel's arguments, and the local memory in which it stages lights.
#if STAGE > 0
#define LIGHT_SET_OF_ARGS(set)                                                  \
    local ShadeLight staged_lights[STAGE];                                      \
    local uint staged_indices[STAGE];                                           \
    LightSet set = light_set(lights, EXTRAS_OF_ARGS, light_count + node_count); \
    set.staged = staged_lights;                                                 \
    set.staged_indices = staged_indices
#else
#define LIGHT_SET_OF_ARGS(set) \
    LightSet set = light_set(lights, EXTRAS_OF_ARGS, light_count + node_count)
#endif

// `rows`: of `lights`.
static inline LightSet light_set(global const StoredLight* lights, LightExtras extras, uint rows) {
    LightSet set;
    set.lights = lights;
    set.extras = extras;
#if LIGHT_GROUPS
    set.first_directional = rows;
    set.mine = (MASK)(-1);
#endif
    return set;
}

// The sum of its group that a light joins; `place`: in extras.groups.
#define GROUP_OF(set, place) ((set).groups + (set).extras.groups[place])
#define DIRECTIONAL_PLACE(set, i) ((set).first_directional + (i))

static inline LightSum select_sum(MASK mask, LightSum a, LightSum b) {
#define SELECT_TERM(has, term) \
    if (has) a.term = select3(mask, a.term, b.term);
    LIGHT_TERMS(SELECT_TERM)
    return a;
}

#if SHADOWS
#if SHADOWS == SHADOWS_BITS
// The first of the bits' places of a list's entry.
static inline uint place_of_entry(LightSet set, uint entry) {
#if SAMPLED_SHADOWS
    return set.directional_count + entry * light_slots(set.pick.rays);
#else
    return set.directional_count + entry;
#endif
}
#endif

// The lanes that see the light of a list's entry.
static inline MASK sees_entry(LightSet set, uint entry, uint light) {
#if SHADOWS == SHADOWS_BITS
    return sees_light(set.shadows, place_of_entry(set, entry));
#else
    return sees(set.shadows,
                shadow_point_light(set.shadows.scene.view, LIGHT_AT(set.lights, light)));
#endif
}

static inline MASK sees_directional(LightSet set, uint i) {
#if SHADOWS == SHADOWS_BITS
    return sees_light(set.shadows, i);
#else
    return sees(set.shadows, shadow_directional_light(set.shadows.scene.view, set.directional[i]));
#endif
}

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
#define ADD_SAMPLED(set, entry, light, sum, group, ONE)                           \
    {                                                                             \
        LightSum taken = zero_sum();                                              \
        ADD_ALONE(set, entry, light, taken, ONE)                                  \
        (sum) = add_sums(sum, taken);                                             \
        *(group) = add_sums(*(group), select_sum((set).mine, taken, zero_sum())); \
    }
#else
#define ADD_SAMPLED(set, entry, light, sum, group, ONE) ADD_ALONE(set, entry, light, sum, ONE)
#endif
#endif
#endif

// To join two sums, a light is evaluated once with colour 1, and its colour is multiplied in when
// it is added. The bits stay, as each term is fma(weight, colour, sum). Not with random ranges,
// whose weight needs the colour.
#if LIGHT_GROUPS && !HAS_RANDOM_RANGES
static inline ShadeLight weighed(ShadeLight light) {
    light.color_scale.xyz = (float3)(1.0f);
    return light;
}

static inline DirectionalLight weighed_directional(DirectionalLight light) {
    light.color = (float4)(1.0f);
    return light;
}

#define WEIGH(EVALUATED) LightSum weights = EVALUATED(zero_sum());
#define LIT(sum, color, EVALUATED) add_colored(sum, weights, color)
#else
#define weighed(light) (light)
#define weighed_directional(light) (light)
#define WEIGH(EVALUATED)
#define LIT(sum, color, EVALUATED) EVALUATED(sum)
#endif

#if SHADOWS
#if TINTED_SHADOWS
#define TINT_VIEW(set) (set).tints.scene.view
// Where surfaces tint the light: `tinted_lanes` and each colour's `share`.
#define FIND_TINT(set, light, lanes) \
    FV3 share;                       \
    (set).tints.wanted = (lanes);    \
    MASK tinted_lanes = tinted((set).tints, light, &share);
// There `sum` plus the share of the light alone, in place of `lit`.
#define TINT(sum, lit, color, EVALUATED)                                    \
    if (lane_any(tinted_lanes)) {                                           \
        LightSum one = LIT(zero_sum(), color, EVALUATED);                   \
        (lit) = select_sum(tinted_lanes, add_tinted(sum, share, one), lit); \
    }
#else
#define FIND_TINT(set, light, lanes)
#define TINT(sum, lit, color, EVALUATED)
#endif

#define ADD_LIT(sum, color, lanes, EVALUATED)      \
    {                                              \
        LightSum lit = LIT(sum, color, EVALUATED); \
        TINT(sum, lit, color, EVALUATED)           \
        (sum) = select_sum(lanes, lit, sum);       \
    }
#if LIGHT_GROUPS
#define ADD_TO_GROUP(set, group, color, lanes, EVALUATED) \
    {                                                     \
        LightSum in_group = *(group);                     \
        MASK joining = (lanes) & (set).mine;              \
        ADD_LIT(in_group, color, joining, EVALUATED)      \
        *(group) = in_group;                              \
    }
#else
#define ADD_TO_GROUP(set, group, color, lanes, EVALUATED)
#endif

// ADD_SEEN(set, sum, group, color, seen, light, EVALUATED): adds a light of this colour where
// `seen`, to `group` also. EVALUATED(sum): the sum with it, or with the white light; it is computed
// only if any lane sees it. light: as shadow rays have it.
#define ADD_SEEN(set, sum, group, color, seen, light, EVALUATED) \
    {                                                            \
        MASK lanes = (seen);                                     \
        if (lane_any(lanes)) {                                   \
            FIND_TINT(set, light, lanes)                         \
            WEIGH(EVALUATED)                                     \
            ADD_LIT(sum, color, lanes, EVALUATED)                \
            ADD_TO_GROUP(set, group, color, lanes, EVALUATED)    \
        }                                                        \
    }
#else
#if LIGHT_GROUPS
#define ADD_TO_GROUP(set, group, color, EVALUATED) \
    *(group) = select_sum((set).mine, LIT(*(group), color, EVALUATED), *(group));
#else
#define ADD_TO_GROUP(set, group, color, EVALUATED)
#endif
#define ADD_SEEN(set, sum, group, color, seen, light, EVALUATED) \
    {                                                            \
        WEIGH(EVALUATED)                                         \
        (sum) = LIT(sum, color, EVALUATED);                      \
        ADD_TO_GROUP(set, group, color, EVALUATED)               \
    }
#endif

// MARKED(set, entry, light, sum, ADD): ADD, which adds the light to `sum`, and its candidates.
#if MARK_CANDIDATES
#define MARKED(set, entry, light, sum, ADD)                                                      \
    {                                                                                            \
        LightSum before = (sum);                                                                 \
        ADD mark_candidates((set).candidates, (set).extras, entry, light, before, sum, &so_far); \
    }
#else
#define MARKED(set, entry, light, sum, ADD) ADD
#endif

static inline uint light_of_entry(global const LIGHT_INDEX* list, uint entry) {
#if ALL_LIGHTS
    return entry;
#else
    return list[entry];
#endif
}

#if STAGE > 0
static inline void stage_batch(LightSet set, global const LIGHT_INDEX* list, uint first, uint end) {
    uint item = get_local_id(1) * get_local_size(0) + get_local_id(0);
    uint items = get_local_size(0) * get_local_size(1);
    for (uint i = item; first + i < end; i += items) {
        uint light = light_of_entry(list, first + i);
        set.staged_indices[i] = light;
        set.staged[i] = LIGHT_AT(set.lights, light);
    }
}
#endif

// Adds the lights of list[0..count) to `total` where `wanted`. The whole work-group calls this with
// the same list: it may stage the lights together.
static inline LightSum sum_lights(LightSum total, bool wanted, ShadingPoint p, LightSet set,
                                  global const LIGHT_INDEX* list, uint count) {
    RunningSum sum = start_sum(total);
#if MARK_CANDIDATES
    FV so_far = fv(0.0f);
#endif
#if STAGE > 0
    for (uint first = 0; first < count; first += STAGE) {
        uint end = min(first + STAGE, count);
        barrier(CLK_LOCAL_MEM_FENCE);  // the batch before is used up
        stage_batch(set, list, first, end);
        barrier(CLK_LOCAL_MEM_FENCE);  // the batch is complete
        for (uint i = 0; wanted && i < end - first; ++i) {
            uint light = set.staged_indices[i];
            sum = enter_block(sum, light);
#if SAMPLED_SHADOWS
            ADD_SAMPLED(set, first + i, light, sum.block, GROUP_OF(set, light),
                        EVALUATE(zero_sum(), p, set.staged[i], set.extras, light))
#else
#define STAGED_LIGHT(sum) EVALUATE(sum, p, weighed(set.staged[i]), set.extras, light)
            MARKED(set, first + i, light, sum.block,
                   ADD_SEEN(set, sum.block, GROUP_OF(set, light), set.staged[i].color_scale,
                            sees_entry(set, first + i, light),
                            shadow_point_light(TINT_VIEW(set), set.staged[i]), STAGED_LIGHT))
#endif
        }
    }
#else
    if (!wanted) return total;
    for (uint i = 0; i < count; ++i) {
        uint light = light_of_entry(list, i);
        sum = enter_block(sum, light);
#if SAMPLED_SHADOWS
        ADD_SAMPLED(set, i, light, sum.block, GROUP_OF(set, light),
                    EVALUATE(zero_sum(), p, LIGHT_AT(set.lights, light), set.extras, light))
#else
#define LISTED_LIGHT(sum) EVALUATE(sum, p, weighed(LIGHT_AT(set.lights, light)), set.extras, light)
        MARKED(
            set, i, light, sum.block,
            ADD_SEEN(set, sum.block, GROUP_OF(set, light), LIGHT_AT(set.lights, light).color_scale,
                     sees_entry(set, i, light),
                     shadow_point_light(TINT_VIEW(set), LIGHT_AT(set.lights, light)), LISTED_LIGHT))
#endif
    }
#endif
    return finish_sum(sum);
}

static inline LightSum sum_directional(ShadingPoint p, LightSet set,
                                       global const DirectionalLight* lights, uint count) {
    LightSum sum = zero_sum();
#if HAS_DIRECTIONAL_LIGHTS
    for (uint i = 0; i < count; ++i) {
#if SAMPLED_SHADOWS
        ADD_SAMPLED(set, i, PICKED_DIRECTIONAL + i, sum, GROUP_OF(set, DIRECTIONAL_PLACE(set, i)),
                    evaluate_directional(zero_sum(), p, lights[i]))
#else
#define PARALLEL_LIGHT(sum) evaluate_directional(sum, p, weighed_directional(lights[i]))
        ADD_SEEN(set, sum, GROUP_OF(set, DIRECTIONAL_PLACE(set, i)), lights[i].color,
                 sees_directional(set, i), shadow_directional_light(TINT_VIEW(set), lights[i]),
                 PARALLEL_LIGHT)
#endif
    }
#endif
    return sum;
}
#endif
