// SPDX-License-Identifier: Apache-2.0
// Decides for each pixel which lights of its list a shadow ray goes to, as bits in
// cast_shadows' words: see kernels/shadows/shadow_pick.h. Of lights with a size only those that
// shade's MARK_CANDIDATES has marked there.
//   draw_shadows_clear  words to 0
//   draw_shadows        one work-item picks for VW pixels, neighbours in the order of their tile's
//                       clusters
#define ORDERED_PIXELS 1
#include "kernels/device/lit_item.h"
#include "kernels/device/radiance.h"
#include "kernels/shadows/cast_shadows.h"
#include "kernels/shadows/shadow_pick.h"

kernel void draw_shadows_clear(WORD_ARGS(), uint tile_count) {
    uint count = min(word_offsets[tile_count], word_capacity);
    for (size_t i = get_global_id(0); i < count; i += get_global_size(0)) words[i] = 0u;
}

#if HAS_AREA_LIGHTS
// The lanes that may pick each lobe of a light whose first slot is `first`; whether any may.
static inline bool find_candidates(ShadowBits bits, uint first, MASK mine, float rays, MASK* may) {
    MASK any = (MASK)(0);
    for (uint lobe = 0; lobe < AREA_LOBES; ++lobe) {
        may[lobe] = mine & sees_light(bits, first + light_ray_slots(rays) + lobe);
        any |= may[lobe];
    }
    return lane_any(any);
}

// The bits of a lobe's slots, from `first` on.
static inline void put_slots(ShadowBits bits, uint first, MASK mine, FV pairs, global uint* words) {
    for (uint slot = 0; lane_any(mine & casts_slot(pairs, slot)); ++slot) {
        put_bits(bits, first + slot, mine & casts_slot(pairs, slot), words);
    }
}
#endif

kernel void draw_shadows(LIT_ARGS, WORD_ARGS(), SAMPLE_ARGS) {
    BEGIN_ORDERED_ITEM;
    if (!HAS_USABLE_WORDS(at.tile)) return;
    Surface s = load_surface(g, item.pixels, item.z);
    ShadingPoint p = make_shading_point(s, view.orthographic != 0u);
    ShadowPick pick = make_pick(s, p, SAMPLES_OF_ARGS, view, item.pixels, at);
    LightExtras extras = EXTRAS_OF_ARGS;
    FOR_EACH_CLUSTER_OF(item, i, mine, active, at.tile) {
        ShadowBits bits =
            bits_of_cluster(words + word_offsets[at.tile], clusters + i, place_of_item(at.x, at.y));
#if HAS_DIRECTIONAL_LIGHTS
        for (uint j = 0; j < directional_count; ++j) {
            LightSum one = evaluate_directional(zero_sum(), p, directional_lights[j]);
            FV alone = light_alone(pick, one);
            put_bits(bits, j, mine & picks_light(pick, alone, PICKED_DIRECTIONAL + j), words);
        }
#endif
        for (uint j = 0; j < clusters[i].list_count; ++j) {
            uint light = lists[clusters[i].list_begin + j];
            uint first = directional_count + j * light_slots(rays);
#if HAS_AREA_LIGHTS
            MASK may[AREA_LOBES];
            bool has_candidates = find_candidates(bits, first, mine, rays, may);
            bool is_area = has_size(shape_of_light(extras, light));
            if (is_area && !has_candidates) continue;
#endif
            LightSum one = EVALUATE(zero_sum(), p, LIGHT_AT(lights, light), extras, light);
#if HAS_AREA_LIGHTS
            if (is_area) {
                for (uint lobe = 0; lobe < AREA_LOBES; ++lobe, first += lobe_slots(rays)) {
                    FV part = light_alone(pick, lobe_part(one, lobe));
                    FV pairs = picked_pairs(pick, part, light, lobe);
                    put_slots(bits, first, may[lobe], pairs, words);
                }
                continue;
            }
#endif
            put_bits(bits, first, mine & picks_light(pick, light_alone(pick, one), light), words);
        }
    }
}
