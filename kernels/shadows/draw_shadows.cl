// SPDX-License-Identifier: Apache-2.0
// Which pixels draw a shadow ray to which light of their cluster's list, as bits in cast_shadows'
// words: see kernels/shadows/shadow_draw.h.
//   draw_shadows_clear  words to 0
//   draw_shadows        one work-item draws for VW pixels, neighbours in the order of their tile's
//                       clusters
#define ORDERED_PIXELS 1
#include "kernels/device/radiance.h"
#include "kernels/device/stored_light.h"
#include "kernels/shadows/cast_shadows.h"
#include "kernels/shadows/shadow_draw.h"

kernel void draw_shadows_clear(global const uint* restrict word_offsets, uint tile_count,
                               global uint* restrict words) {  // out
    for (size_t i = get_global_id(0); i < word_offsets[tile_count]; i += get_global_size(0)) {
        words[i] = 0u;
    }
}

static inline void put_bits(ShadowBits bits, uint i, MASK drawn, global uint* words) {
    if (!lane_any(drawn)) return;
    atomic_or(words + (bits.words - words) + i * bits.stride, lane_ballot(drawn) << bits.shift);
}

kernel void draw_shadows(
    global const uchar* restrict gbuffer, GBufferLayout layout, View view,
    global const float* restrict srgb,      // [256]
    global const float* restrict radiance,  // [3][height][stride], if all lights are seen
    global const DirectionalLight* restrict directional, uint directional_count,
    global const StoredLight* restrict lights,
#if HAS_LIGHT_PROFILES
    global const AimedProfile* restrict aimed_profiles,  // [light_count], view space
    global const float* restrict profile_tables,
#endif
    ClusterGrid grid,
    global const uint* restrict cluster_offsets,    // [tiles + 1]
    global const ActiveCluster* restrict clusters,  // [cluster_capacity]
    uint cluster_capacity,
    global const uchar* restrict order,  // [tiles][FINE_TILE_PIXELS]
    global const LIGHT_INDEX* restrict lists,
    global const uint* restrict word_offsets,  // [tiles + 1]
    float rays, uint seed,
    global uint* restrict words) {  // out: bits set
    uint x = (uint)get_global_id(0) * VW;
    uint y = get_global_id(1);
    if (y >= view.height) return;
    uint tile = fine_tile_of(view, x, y);
    uint place = place_of_item(x, y);
    if (cluster_offsets[tile] == cluster_offsets[tile + 1]) return;
    Pixels pixels = pixels_of_item(view, x, y, order);
    GBuffer g = {gbuffer, layout, view, srgb};
    FV depth01 = load_depth01(g, pixels);
    MASK drawn = lane_mask(depth01 > fv(0.0f)) & within_width(view, pixels);
    if (!lane_any(drawn)) return;
    FV z = view_depth(view, pixels.x, pixels.y, lane_select(drawn, depth01, fv(1.0f)));
    Surface s = load_surface(g, pixels, z);
    ShadingPoint p = make_shading_point(s, view.orthographic != 0u);
    ShadowDraw draw = make_draw(s, radiance, view, pixels, x, y, rays, seed);
#if HAS_LIGHT_PROFILES
    LightProfiles profiles = {aimed_profiles, profile_tables};
#endif
    UV slice = fine_slice_of_depth(grid, z);
    uint end = min(cluster_offsets[tile + 1], cluster_capacity);
    for (uint i = cluster_offsets[tile]; i < end; ++i) {
        MASK mine = lane_mask(slice == (UV)(clusters[i].slice)) & drawn;
        if (!lane_any(mine)) continue;
        ShadowBits bits = bits_of_cluster(words + word_offsets[tile], clusters + i, place);
#if HAS_DIRECTIONAL_LIGHTS
        for (uint j = 0; j < directional_count; ++j) {
            LightSum one = evaluate_directional(zero_sum(), p, directional[j]);
            FV alone = light_alone(draw, one);
            put_bits(bits, j, mine & draws_light(draw, alone, DRAWN_DIRECTIONAL + j), words);
        }
#endif
        for (uint j = 0; j < clusters[i].list_count; ++j) {
            uint light = lists[clusters[i].list_begin + j];
            LightSum one = EVALUATE(zero_sum(), p, LIGHT_AT(lights, light), profiles, light);
            FV alone = light_alone(draw, one);
            put_bits(bits, directional_count + j, mine & draws_light(draw, alone, light), words);
        }
    }
}
