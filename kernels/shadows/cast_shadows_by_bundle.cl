// SPDX-License-Identifier: Apache-2.0
// cast_shadows by a walk for each light and VW pixels, as shade_all does it: it checks walks for
// whole clusters, and benchmarks compare them with it. One work-item takes VW pixels, neighbours in
// the order of their tile. Bits of background do not change.
#define ORDERED_PIXELS 1
#include "kernels/shadows/cast_shadows.h"
#include "kernels/shadows/shadow_rays.h"

#if PICKED_ONLY
// As sees_light(): read as one, since other items take off bits of the same word.
static inline MASK is_picked(ShadowBits bits, uint i, global uint* words) {
    uint word = atomic_or(words + (bits.words - words) + i * bits.stride, 0u);
    return lane_mask(((UV)(word >> bits.shift) >> lane_numbers & 1u) != (UV)(0u));
}
#endif

// Writes the bits of the item's pixels that are the cluster's, from lane 0 on.
static inline void put_seen(ShadowBits bits, uint j, MASK mine, MASK seen, global uint* words) {
    global uint* word = words + (bits.words - words) + j * bits.stride;
#if PICKED_ONLY
    atomic_and(word, ~(lane_ballot(seen) << bits.shift));
#else
    atomic_and(word, ~(lane_ballot(mine) << bits.shift));
    atomic_or(word, lane_ballot(seen) << bits.shift);
#endif
}

// The bits of all slots of one light at the pixels rays.wanted. first: of the slots' words.
static inline void cast_slots(ShadowRays rays, CastLights from, ShadowLight light, uint slots,
                              uint first, ShadowBits bits, global uint* words) {
    MASK mine = rays.wanted;
    for (uint slot = 0; slot < slots;) {
#if PICKED_ONLY
        rays.wanted = mine & is_picked(bits, first + slot, words);
        if (!lane_any(rays.wanted)) {
            slot = next_lobe(from, slot);
            continue;
        }
#endif
        put_seen(bits, first + slot, mine, sees(rays, light_at_slot(from, light, slot)), words);
        ++slot;
    }
}

kernel void cast_shadows(
    LIT_ARGS, SHADOW_ARGS, TARGET_ARGS, SAMPLE_ARGS,
    global ShadowCounts* restrict counts) {  // out [work-items] with COUNT_SHADOWS, where the tile
                                             // has lights
    ItemPlace at = place_in_planes(view);
    if (!at.inside || !HAS_USABLE_WORDS(at.tile)) return;
    uint place = place_of_item(at.x, at.y);
    Clusters active = CLUSTERS_OF_ARGS;
    CastLights from = CAST_LIGHTS_OF_ARGS;
    uint key = key_of_tile(view, from, at.tile);
    ShadowPoints points;
    reset_counts(&points);
    Pixels pixels = pixels_of_item(view, at.x, at.y, order);
    load_origins(&points, 0u, origins, view.stride * view.height, pixels);
    load_area_pixels(&points, 0u, GBUFFER_OF_ARGS, pixels);
    ShadowRays walks;
    walks.scene = SHADOW_SCENE_OF_ARGS;
    walks.points = &points;
    FOR_EACH_CLUSTER(i, active, at.tile) {
        uint first = clusters[i].first_pixel;
        UV places = lane_numbers + place;
        walks.wanted = lane_mask(places >= (UV)(first)) &
                       lane_mask(places < (UV)(first + clusters[i].pixel_count));
        if (!lane_any(walks.wanted)) continue;
        ShadowBits bits = bits_of_cluster(words + word_offsets[at.tile], clusters + i, place);
        for (uint j = 0; j < count_of_cluster(from, clusters + i); ++j) {
#if !PICKED_ONLY
            uint word = word_offsets[at.tile] + clusters[i].first_word + j * bits.stride;
            if (is_kept(kept, word)) continue;
#endif
            ShadowLight light = light_of_cluster(from, shadow, clusters + i, j, key);
            cast_slots(walks, from, light, slots_of(from, j), slots_before(from, j), bits, words);
        }
    }
#if COUNT_SHADOWS
    counts[get_global_id(1) * get_global_size(0) + get_global_id(0)] = points.counts;
#endif
}
