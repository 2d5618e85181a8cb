// SPDX-License-Identifier: Apache-2.0
// The lights that a shading kernel sums, with what shadows, candidates and groups need of them.
#ifndef KILOLUX_DEVICE_LIGHT_SET_H
#define KILOLUX_DEVICE_LIGHT_SET_H
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
    const Surface* surface;
    const ShadingPoint* point;
    FV3* groups;             // [1 + LIGHT_GROUPS], radiance that the surface reflects; 0: unused
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

// The group that a light joins, 0: none; `place`: in extras.groups.
#define GROUP_OF(set, place) ((set).extras.groups[place])
#define WHITE fv3(fv(1.0f), fv(1.0f), fv(1.0f))
#define DIRECTIONAL_PLACE(set, i) ((set).first_directional + (i))

// `a` in the lanes of `mask`, else `b`.
static inline LightSum select_sum(MASK mask, LightSum a, LightSum b) {
#define SELECT_TERM(has, term) \
    if (has) a.term = select3(mask, a.term, b.term);
    LIGHT_TERMS(SELECT_TERM)
    return a;
}

#if LIGHT_GROUPS
static inline FV3 fma3(FV3 a, FV3 b, FV3 c) {
    return fv3(fma(a.x, b.x, c.x), fma(a.y, b.y, c.y), fma(a.z, b.z, c.z));
}

// Adds a light to its group, not 0: `color` times the light of which `weights` is the sum.
static inline void join_group(LightSet set, uint group, MASK lanes, FV3 color, LightSum weights) {
    FV3 lit = reflected_radiance(*set.surface, *set.point, weights);
    MASK joining = lanes & set.mine;
#if LIGHT_GROUPS <= 8
    // Constant indices let the sums stay in registers.
#pragma unroll
    for (uint i = 1u; i <= LIGHT_GROUPS; ++i) {
        if (i == group)
            set.groups[i] = select3(joining, fma3(lit, color, set.groups[i]), set.groups[i]);
    }
#else
    set.groups[group] = select3(joining, fma3(lit, color, set.groups[group]), set.groups[group]);
#endif
}
#endif
#endif
