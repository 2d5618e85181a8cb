// SPDX-License-Identifier: Apache-2.0
// Takes over the bits that the saved frame has for the same pixels and clusters: those of lights
// that stand where they stood. A work-item takes every KEEP_ITEMS-th light of a tile's clusters.
#include "kernels/device/lit_item.h"
#include "kernels/shadows/shadow_bits.h"

// The lights of the saved frame.
typedef struct LightsBefore {
    global const float4* bounds;
    uint count;
    global const DirectionalLight* directional;
    uint directional_count;
    global const LIGHT_INDEX* lists;
} LightsBefore;

#define NO_PLACE 0xffffffffu

static inline bool same_bits(float4 a, float4 b) {
    return as_uint(a.x) == as_uint(b.x) && as_uint(a.y) == as_uint(b.y) &&
           as_uint(a.z) == as_uint(b.z) && as_uint(a.w) == as_uint(b.w);
}

// Where `index` is in an ascending list.
static inline uint place_in_list(global const LIGHT_INDEX* list, uint count, uint index) {
    uint first = 0u, end = count;
    while (first < end) {
        uint middle = (first + end) / 2u;
        if (list[middle] < index) {
            first = middle + 1u;
        } else {
            end = middle;
        }
    }
    return first < count && list[first] == index ? first : NO_PLACE;
}

// Place among the saved bits of a cluster of the light that had `index_before` then and has `bound`
// now.
static inline uint place_before(LightsBefore before, global const ActiveCluster* cluster,
                                float4 bound, uint index_before) {
    if (index_before >= before.count || !same_bits(bound, before.bounds[index_before])) {
        return NO_PLACE;
    }
    uint place =
        place_in_list(before.lists + cluster->list_begin, cluster->list_count, index_before);
    return place == NO_PLACE ? NO_PLACE : before.directional_count + place;
}

static inline uint directional_place_before(LightsBefore before, DirectionalLight light, uint j) {
    bool stands =
        j < before.directional_count && same_bits(light.to_light, before.directional[j].to_light);
    return stands ? j : NO_PLACE;
}

kernel void keep_shadows(LIT_ARGS, WORD_ARGS(), BEFORE_ARGS,
                         global const uint* restrict index_before,  // of each light; null: the same
                         global uint* restrict kept) {              // in/out: see TARGET_ARGS
    uint tile = get_global_id(0) / KEEP_ITEMS;
    uint item = get_global_id(0) % KEEP_ITEMS;
    if (tile >= fine_tile_count(view) || !HAS_USABLE_WORDS(tile)) return;
    LightsBefore before = {bounds_before, count_before, directional_before,
                           directional_count_before, lists_before};
    Clusters active = CLUSTERS_OF_ARGS;
    FOR_EACH_CLUSTER(i, active, tile) {
        uint first = clusters[i].first_pixel;
        uint size = shadow_words(first, first + clusters[i].pixel_count);
        uint to = word_offsets[tile] + clusters[i].first_word;
        uint from = word_offsets_before[tile] + clusters_before[i].first_word;
        uint count = directional_count + clusters[i].list_count;
        for (uint j = item; j < count; j += KEEP_ITEMS) {
            uint place;
            if (j < directional_count) {
                place = directional_place_before(before, directional_lights[j], j);
            } else {
                uint index = lists[clusters[i].list_begin + j - directional_count];
                place = place_before(before, clusters_before + i, bounds[index],
                                     index_before ? index_before[index] : index);
            }
            if (place == NO_PLACE) continue;
            uint word = to + j * size;
            for (uint k = 0; k < size; ++k) words[word + k] = words_before[from + place * size + k];
            atomic_or(kept + word / 32u, 1u << word % 32u);
        }
    }
}
