// SPDX-License-Identifier: Apache-2.0
// Adds a light to the sum of all lights and, with LIGHT_GROUPS, to that of its group: where it is
// seen, and as surfaces tint it.
#ifndef KILOLUX_DEVICE_ADD_LIGHT_H
#define KILOLUX_DEVICE_ADD_LIGHT_H
#include "kernels/shading/hidden_lights.h"

// A light in a group is added to two sums. It is evaluated once, with colour 1, and each sum
// multiplies by the colour: the bits stay, as each term is fma(weight, colour, sum). Not with
// random ranges, whose weight needs the colour.
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
#define ALONE(EVALUATED) weights
#define COLOR_ALONE(color) fv3(fv((color).x), fv((color).y), fv((color).z))
#else
#define weighed(light) (light)
#define weighed_directional(light) (light)
#define WEIGH(EVALUATED)
#define LIT(sum, color, EVALUATED) EVALUATED(sum)
#define ALONE(EVALUATED) EVALUATED(zero_sum())
#define COLOR_ALONE(color) WHITE
#endif

#if SHADOWS && TINTED_SHADOWS
#define TINT_VIEW(set) (set).tints.scene.view
// Where surfaces tint the light: `tinted_lanes` and each colour's `share`.
#define FIND_TINT(set, light, lanes) \
    FV3 share;                       \
    (set).tints.wanted = (lanes);    \
    MASK tinted_lanes = tinted((set).tints, light, &share);
#define TINT_COLOR(color) (color) = select3(tinted_lanes, fma3(share, color, zero3()), color);
// There `sum` plus the share of the light alone, in place of `lit`.
#define TINT(sum, lit, color, EVALUATED)                                    \
    if (lane_any(tinted_lanes)) {                                           \
        LightSum one = LIT(zero_sum(), color, EVALUATED);                   \
        (lit) = select_sum(tinted_lanes, add_tinted(sum, share, one), lit); \
    }
#else
#define FIND_TINT(set, light, lanes)
#define TINT_COLOR(color)
#define TINT(sum, lit, color, EVALUATED)
#endif

#if LIGHT_GROUPS
#define ADD_TO_GROUP(set, group, color, lanes, EVALUATED)        \
    if ((group) != 0u) {                                         \
        FV3 factor = COLOR_ALONE(color);                         \
        TINT_COLOR(factor)                                       \
        join_group(set, group, lanes, factor, ALONE(EVALUATED)); \
    }
#else
#define ADD_TO_GROUP(set, group, color, lanes, EVALUATED)
#endif

// ADD_SEEN(set, sum, group, color, seen, light, EVALUATED): adds a light of this colour where
// `seen`, to `group` also. EVALUATED(sum): the sum with it, or with the white light; it is computed
// only if any lane sees it. light: as shadow rays have it.
#if SHADOWS
#define ADD_SEEN(set, sum, group, color, seen, light, EVALUATED) \
    {                                                            \
        MASK lanes = (seen);                                     \
        if (lane_any(lanes)) {                                   \
            FIND_TINT(set, light, lanes)                         \
            WEIGH(EVALUATED)                                     \
            LightSum lit = LIT(sum, color, EVALUATED);           \
            TINT(sum, lit, color, EVALUATED)                     \
            (sum) = select_sum(lanes, lit, sum);                 \
            ADD_TO_GROUP(set, group, color, lanes, EVALUATED)    \
        }                                                        \
    }
#else
#define ADD_SEEN(set, sum, group, color, seen, light, EVALUATED) \
    {                                                            \
        WEIGH(EVALUATED)                                         \
        (sum) = LIT(sum, color, EVALUATED);                      \
        ADD_TO_GROUP(set, group, color, (MASK)(-1), EVALUATED)   \
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
#endif
