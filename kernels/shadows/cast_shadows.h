// SPDX-License-Identifier: Apache-2.0
// The common part of all forms of cast_shadows.
//
// Words of bits: tile after tile, cluster after cluster, for each directional light and each light
// of the cluster's list as many words of 32 pixels as the cluster touches. Bit i of word w is place
// 32 w + i in the tile's order, w counted from the cluster's first pixel's. In scenes with area
// lights each light of a list has that many words for each of its slots.
#ifndef KILOLUX_DEVICE_CAST_SHADOWS_H
#define KILOLUX_DEVICE_CAST_SHADOWS_H
// With PICKED_ONLY the words hold the pixels that pick a light (draw_shadows), and afterwards those
// of them from which it is hidden; else those that see it.
#ifndef PICKED_ONLY
#define PICKED_ONLY 0
#endif
#define AREA_SHADOWS (PICKED_ONLY && HAS_AREA_LIGHTS)
#include "kernels/device/lit_item.h"
#include "kernels/shadows/shadow_bits.h"
#include "kernels/shadows/shadow_space.h"

// The lights of a tile's clusters.
typedef struct CastLights {
    global const DirectionalLight* directional;
    uint directional_count;
    global const StoredLight* lights;
    global const LIGHT_INDEX* lists;
    LightExtras extras;
    float rays;  // SAMPLE_ARGS
    uint seed;
} CastLights;
#define CAST_LIGHTS_OF_ARGS \
    ((CastLights){directional_lights, directional_count, lights, lists, EXTRAS_OF_ARGS, rays, seed})

static inline uint count_of_cluster(CastLights from, global const ActiveCluster* cluster) {
    return from.directional_count + cluster->list_count;
}

// The j-th light of a cluster, directional ones first. key: of the tile.
static inline ShadowLight light_of_cluster(CastLights from, ShadowView shadow,
                                           global const ActiveCluster* cluster, uint j, uint key) {
    if (j < from.directional_count) return shadow_directional_light(shadow, from.directional[j]);
    uint index = from.lists[cluster->list_begin + j - from.directional_count];
    ShadeLight light = LIGHT_AT(from.lights, index);
    ShadowLight out = shadow_point_light(shadow, light);
#if AREA_SHADOWS
    LightShape shape = shape_of_light(from.extras, index);
    out = with_shape(out, shadow, light.position_inv_range2, shape, light_key(key, index));
#endif
    return out;
}

#if !PICKED_ONLY
// Whether the bits of a light whose first word is this one are there already.
static inline bool is_kept(global const uint* kept, uint word) {
    return kept != 0 && (kept[word / 32u] >> word % 32u & 1u) != 0u;
}
#endif

static inline uint key_of_tile(View view, CastLights from, uint tile) {
    uint tiles_x = fine_tiles_x(view);
    return tile_key(view, from.seed, tile % tiles_x * FINE_TILE, tile / tiles_x * FINE_TILE);
}

// Slots of the rays to the j-th light of a cluster, and all slots before them.
static inline uint slots_of(CastLights from, uint j) {
    return j < from.directional_count ? 1u : light_ray_slots(from.rays);
}
static inline uint slots_before(CastLights from, uint j) {
    return j < from.directional_count
               ? j
               : from.directional_count + (j - from.directional_count) * light_slots(from.rays);
}

// The first slot of the lobe after that of a slot: pixels use the first ones of a lobe.
static inline uint next_lobe(CastLights from, uint slot) {
#if AREA_SHADOWS
    uint slots = lobe_slots(from.rays);
    return (slot / slots + 1u) * slots;
#else
    return slot + 1u;
#endif
}

// The light as the target of a slot's rays.
static inline ShadowLight light_at_slot(CastLights from, ShadowLight light, uint slot) {
#if AREA_SHADOWS
    if (light.is_area) light.area = at_slot(light.area, slot, from.rays);
#endif
    return light;
}

// The bits of the pixels that pick the j-th light, of one word. words: that of the first slot, of
// `count` for each slot.
static inline uint picked_bits(CastLights from, uint j, global const uint* words, uint count) {
    uint bits = 0u;
    for (uint slot = 0; slot < slots_of(from, j); slot = next_lobe(from, slot)) {
        bits |= words[slot * count];
    }
    return bits;
}

// Whether any pixel picks a light whose first slot's words are `words`, `count` for each slot.
static inline bool is_picked_by_any(CastLights from, uint j, global const uint* words, uint count) {
    uint bits = 0u;
    for (uint i = 0; i < count; ++i) bits |= picked_bits(from, j, words + i, count);
    return bits != 0u;
}

kernel void cast_shadows_reserve(uint tile_count, uint directional_count,
                                 uint slots,                        // of each light of a list
                                 CLUSTER_ARGS(),                    // in/out: shadow_words set
                                 global uint* restrict reserves) {  // out [tile_count]
    uint tile = get_global_id(0);
    if (tile >= tile_count) return;
    Clusters active = CLUSTERS_OF_ARGS;
    ulong sum = 0;  // saturates, as in refine_lights
    uint first = 0;
    FOR_EACH_CLUSTER(i, active, tile) {
        clusters[i].first_pixel = first;
        clusters[i].first_word = (uint)sum;
        uint last = first + clusters[i].pixel_count;
        sum += (ulong)shadow_words(first, last) *
               (directional_count + (ulong)clusters[i].list_count * slots);
        first = last;
    }
    reserves[tile] = (uint)min(sum, (ulong)0xffffffffu);
}
#endif
