// SPDX-License-Identifier: Apache-2.0
// The common part of all forms of cast_shadows.
//
// Words of bits: tile after tile, cluster after cluster, for each directional light and each light
// of the cluster's list as many words of 32 pixels as the cluster touches. Bit i of word w is place
// 32 w + i in the tile's order, w counted from the cluster's first pixel's.
#ifndef KILOLUX_DEVICE_CAST_SHADOWS_H
#define KILOLUX_DEVICE_CAST_SHADOWS_H
// With PICKED_ONLY the words hold the pixels that pick a light (draw_shadows), and afterwards those
// of them from which it is hidden; else those that see it.
#ifndef PICKED_ONLY
#define PICKED_ONLY 0
#endif
#include "kernels/device/lit_item.h"
#include "kernels/shadows/shadow_bits.h"
#include "kernels/shadows/shadow_space.h"

// The j-th light of a cluster, directional ones first.
static inline ShadowLight light_of_cluster(ShadowView shadow, global const ActiveCluster* cluster,
                                           uint j, global const DirectionalLight* directional,
                                           uint directional_count, global const StoredLight* lights,
                                           global const LIGHT_INDEX* lists) {
    if (j < directional_count) return shadow_directional_light(shadow, directional[j]);
    uint light = lists[cluster->list_begin + j - directional_count];
    return shadow_point_light(shadow, LIGHT_AT(lights, light));
}

kernel void cast_shadows_reserve(uint tile_count, uint directional_count,
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
        sum += (ulong)shadow_words(first, last) * (directional_count + clusters[i].list_count);
        first = last;
    }
    reserves[tile] = (uint)min(sum, (ulong)0xffffffffu);
}
#endif
