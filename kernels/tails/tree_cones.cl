// SPDX-License-Identifier: Apache-2.0
// The cone of each active cluster's normals, for cuts through the light tree. One work-item takes
// one fine tile: VW is 1.
#define ORDERED_PIXELS 1
#include "kernels/device/lit_item.h"
#include "kernels/shared/surface.h"
#include "kernels/tails/tree_cut.h"

// Roughness squared below which lobes count as narrower than a diffuse one.
#define WIDE_LOBE 0.5f

// Lobes narrower than a diffuse one vary within smaller angles, in proportion to alpha.
static inline float sharpness_of(float roughness) {
#if SHADING == SHADING_LAMBERT
    return 1.0f;
#else
    return max(1.0f, WIDE_LOBE / clamped_alpha(roughness));
#endif
}

static inline float3 normal_at(GBuffer g, Pixels pixel) {
    FV3 n = load_normal(g, pixel);
    return (float3)(n.x, n.y, n.z);
}

// The least cosine to `axis` of the pixel's normals.
static inline float cosine_at(GBuffer g, Pixels pixel, float3 axis) {
    float cosine = dot(axis, normal_at(g, pixel));
#if HAS_COAT && HAS_COAT_NORMAL
    Surface s = load_surface(g, pixel, 1.0f);
    float3 coat = (float3)(s.coat_normal.x, s.coat_normal.y, s.coat_normal.z);
    if (s.coat > 0.0f) cosine = min(cosine, dot(axis, coat));
#endif
    return cosine;
}

static inline ClusterCone cone_of_pixels(GBuffer g, uint tile, global const uchar* order,
                                         uint first, uint count) {
    float3 sum = (float3)(0.0f);
    float sharpness = 1.0f;
    for (uint i = first; i < first + count; ++i) {
        Pixels pixel = pixels_of_tile(g.view, tile, i, order);
        sum += normal_at(g, pixel);
#if SHADING != SHADING_LAMBERT
        Surface s = load_surface(g, pixel, 1.0f);
        if (is_lit(s)) sharpness = max(sharpness, sharpness_of(s.roughness));
#if HAS_COAT
        if (s.coat > 0.0f) sharpness = max(sharpness, sharpness_of(s.coat_roughness));
#endif
#if HAS_SHEEN_LOBE
        // As wide as its roughness: the distribution is a power 1 / alpha of a sine.
        float width = max(s.sheen_roughness, ROUGHNESS_MIN);
        if (largest_channel(s.sheen) > 0.0f) sharpness = max(sharpness, WIDE_LOBE / width);
#endif
#endif
    }
    float length2 = dot(sum, sum);
    float3 axis = sum * (length2 > 0.0f ? 1.0f / sqrt(length2) : 0.0f);
    float cosine = 1.0f;
    for (uint i = first; i < first + count; ++i) {
        cosine = min(cosine, cosine_at(g, pixels_of_tile(g.view, tile, i, order), axis));
    }
    ClusterCone out;
    cosine = max(cosine - 1e-5f, 0.0f);  // more than the rounding of normals and their lengths
    out.axis_cosine = (float4)(axis, cosine);
    out.sine = sqrt(max(1.0f - cosine * cosine, 0.0f));
    out.sharpness = sharpness;
    out.unused0 = out.unused1 = 0.0f;
    return out;
}

kernel void tree_cones(GBUFFER_ARGS, CLUSTER_ARGS(const), uint tile_count,
                       global ClusterCone* restrict cones) {  // out [cluster_capacity]
    uint tile = get_global_id(0);
    if (tile >= tile_count) return;
    GBuffer g = GBUFFER_OF_ARGS;
    Clusters active = CLUSTERS_OF_ARGS;
    uint first = 0;
    FOR_EACH_CLUSTER(i, active, tile) {
        uint count = clusters[i].pixel_count;
        cones[i] = cone_of_pixels(g, tile, order, first, count);
        first += count;
    }
}
