// SPDX-License-Identifier: Apache-2.0
// Which lanes see a light, by the bits of cast_shadows or by rays that are cast here.
#ifndef KILOLUX_DEVICE_SEEN_LIGHTS_H
#define KILOLUX_DEVICE_SEEN_LIGHTS_H
#include "kernels/shading/light_set.h"

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

#endif
#endif
