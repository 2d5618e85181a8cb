// SPDX-License-Identifier: Apache-2.0
// The variance that drawn ranges (Tails::stochastic) cause in each pixel's luminance, estimated
// from the lights that were drawn: X = f / p with probability p, else 0, has E[X^2 (1 - p)]. Adds
// to what sampled shadows have estimated. One work-item does VW pixels, neighbours in the order of
// their tile's clusters.
#define ORDERED_PIXELS 1
#include "kernels/device/light_index.h"
#include "kernels/device/radiance.h"
#include "kernels/device/stored_light.h"
#include "kernels/shadows/shadow_bits.h"
#include "kernels/shadows/shadow_draw.h"
#include "kernels/shared/cluster_grid.h"

// SHADOWS: 0: every light is seen; 1: words have the pixels that see a light. SAMPLED_SHADOWS: the
// words have those that drew it and from which it is hidden.
#ifndef SHADOWS
#define SHADOWS 0
#endif
#ifndef SAMPLED_SHADOWS
#define SAMPLED_SHADOWS 0
#endif

// The seen share of a light that adds `alone`: what it is, or the estimate that is right in the
// mean.
static inline FV seen_share(ShadowDraw draw, ShadowBits bits, uint i, FV alone) {
#if SAMPLED_SHADOWS
    FV q = draw_probability(draw, alone);
    return lane_select(sees_light(bits, i), fv(1.0f) - fv(1.0f) / q, fv(1.0f));
#elif SHADOWS
    return lane_select(sees_light(bits, i), fv(1.0f), fv(0.0f));
#else
    return fv(1.0f);
#endif
}

kernel void tail_variance(
    global const uchar* restrict gbuffer, GBufferLayout layout, View view,
    global const float* restrict srgb,  // [256]
    uint directional_count,             // first of a cluster's words
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
#if SHADOWS
    global const uint* restrict word_offsets,  // [tiles + 1]
    global const uint* restrict words,
#endif
#if SAMPLED_SHADOWS
    global const float* restrict whole,  // [3][height][stride]: radiance if all lights are seen
    float rays,
#endif
    global float* restrict variance) {  // in/out [height][stride]
    uint x = (uint)get_global_id(0) * VW;
    uint y = get_global_id(1);
    if (y >= view.height) return;
    uint tile = fine_tile_of(view, x, y);
    if (cluster_offsets[tile] == cluster_offsets[tile + 1]) return;
    Pixels pixels = pixels_of_item(view, x, y, order);
    GBuffer g = {gbuffer, layout, view, srgb};
    FV depth01 = load_depth01(g, pixels);
    MASK drawn = lane_mask(depth01 > fv(0.0f)) & within_width(view, pixels);
    if (!lane_any(drawn)) return;
    FV z = view_depth(view, pixels.x, pixels.y, lane_select(drawn, depth01, fv(1.0f)));
    Surface s = load_surface(g, pixels, z);
    ShadingPoint p = make_shading_point(s, view.orthographic != 0u);
    ShadowDraw draw;
#if SAMPLED_SHADOWS
    draw = make_draw(s, whole, view, pixels, x, y, rays, 0u);
#endif
    draw.surface = s;
    draw.surface.emissive = zero3();
#if HAS_LIGHT_PROFILES
    LightProfiles profiles = {aimed_profiles, profile_tables};
#endif
    UV slice = fine_slice_of_depth(grid, z);
    FV sum = fv(0.0f);
    uint end = min(cluster_offsets[tile + 1], cluster_capacity);
    for (uint i = cluster_offsets[tile]; i < end; ++i) {
        MASK mine = lane_mask(slice == (UV)(clusters[i].slice)) & drawn;
        if (!lane_any(mine)) continue;
        ShadowBits bits;
#if SHADOWS
        bits = bits_of_cluster(words + word_offsets[tile], clusters + i, place_of_item(x, y));
#endif
        for (uint j = 0; j < clusters[i].list_count; ++j) {
            uint index = lists[clusters[i].list_begin + j];
            ShadeLight light = LIGHT_AT(lights, index);
            float4 at = light.position_inv_range2;
            if (at.w > 0.0f) continue;
            FV3 v = fv3(fv(at.x) - p.position.x, fv(at.y) - p.position.y, fv(at.z) - p.position.z);
            LightSum one = EVALUATE(zero_sum(), p, light, profiles, index);
            FV alone = light_alone(draw, one);
            FV missed = fv(1.0f) - fv(1.0f) / drawn_weight(light, dot3(v, v));
            FV share = seen_share(draw, bits, directional_count + j, alone);
            sum += lane_select(mine, alone * alone * missed * share, fv(0.0f));
        }
    }
    store_plane(variance, pixels,
                lane_select(drawn, LOAD_PLANE(FV, variance, pixels) + sum, fv(0.0f)));
}
