// SPDX-License-Identifier: Apache-2.0
// cast_shadows by a walk for each light and VW pixels, as shade_all finds out what they see: the
// check of walks for whole clusters, and what those are measured against. One work-item takes VW
// pixels, neighbours in the order of their tile. Bits of background are left as they are.
#define ORDERED_PIXELS 1
#include "kernels/shadows/cast_shadows.h"
#include "kernels/shadows/shadow_rays.h"

// Bits of the item's pixels that are the cluster's, from lane 0 on.
static inline void put_seen(ShadowBits bits, uint j, MASK mine, MASK seen, global uint* words) {
    global uint* word = words + (bits.words - words) + j * bits.stride;
#if DRAWN_ONLY
    atomic_and(word, ~(lane_ballot(seen) << bits.shift));
#else
    atomic_and(word, ~(lane_ballot(mine) << bits.shift));
    atomic_or(word, lane_ballot(seen) << bits.shift);
#endif
}

kernel void cast_shadows(
    View view, ShadowView shadow, global const float* restrict origins,
    global const float4* restrict bounds,                        // [light_count]
    global const DirectionalLight* restrict directional_lights,  // [directional_count]
    uint directional_count,
    global const uint* restrict cluster_offsets,    // [tiles + 1]
    global const ActiveCluster* restrict clusters,  // [cluster_capacity]
    uint cluster_capacity,
    global const uchar* restrict order,  // [tiles][FINE_TILE_PIXELS]
    global const LIGHT_INDEX* restrict lists,
    global const uint* restrict word_offsets,  // [tiles + 1]
    global const ShadowNode* restrict nodes, global const float* restrict casters,
    global const MaskedCaster* restrict masked_casters,
    global const SurfaceMaterial* restrict materials, global const TextureRow* restrict textures,
    global const ulong* restrict texels,
#if COUNT_SHADOWS
    global ShadowCounts* restrict counts,  // out [work-items]: where the tile has lights
#endif
    global uint* restrict words) {  // out
    uint x = (uint)get_global_id(0) * VW;
    uint y = get_global_id(1);
    if (y >= view.height) return;
    uint tile = fine_tile_of(view, x, y);
    uint place = place_of_item(x, y);
    if (word_offsets[tile] == word_offsets[tile + 1]) return;
    ShadowPoints points;
    reset_counts(&points);
    load_origins(&points, 0u, origins, view.stride * view.height,
                 pixels_of_item(view, x, y, order));
    ShadowRays rays;
    rays.scene =
        (ShadowScene){nodes, casters, {masked_casters, materials, {textures, texels}}, shadow};
    rays.points = &points;
    rays.bounds = bounds;
    rays.directional = directional_lights;
    uint end = min(cluster_offsets[tile + 1], cluster_capacity);
    for (uint i = cluster_offsets[tile]; i < end; ++i) {
        uint first = clusters[i].first_pixel;
        UV places = lane_numbers + place;
        MASK mine = lane_mask(places >= (UV)(first)) &
                    lane_mask(places < (UV)(first + clusters[i].pixel_count));
        if (!lane_any(mine)) continue;
        ShadowBits bits = bits_of_cluster(words + word_offsets[tile], clusters + i, place);
        for (uint j = 0; j < directional_count + clusters[i].list_count; ++j) {
            ShadowLight light = light_of_cluster(shadow, clusters + i, j, directional_lights,
                                                 directional_count, bounds, lists);
            rays.drawn = mine;
#if DRAWN_ONLY
            rays.drawn &= sees_light(bits, j);  // the bits are those of drawn lights
#endif
            put_seen(bits, j, mine, sees(rays, light), words);
        }
    }
#if COUNT_SHADOWS
    counts[get_global_id(1) * get_global_size(0) + get_global_id(0)] = points.counts;
#endif
}
