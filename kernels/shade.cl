// SPDX-License-Identifier: Apache-2.0
// Radiance of every pixel: the sum of evaluate() over the lights of its active cluster, or, with
// ALL_LIGHTS, over every light (the reference that lists must not change by a bit).
// One work-item shades VW neighbouring pixels of a row; a work-group lies within one fine tile.
#include "kernels/device/gbuffer.h"
#include "kernels/device/light_index.h"
#include "kernels/shared/cluster_grid.h"
#include "kernels/shared/clusters.h"

#ifndef ALL_LIGHTS
#define ALL_LIGHTS 0
#endif
#ifndef HAS_DIRECTIONAL_LIGHTS
#define HAS_DIRECTIONAL_LIGHTS 0
#endif

// Sum over the lights list[0..count), or lights 0..count with ALL_LIGHTS. Blocked by light index.
static inline LightSum sum_lights(LightSum total, ShadingPoint p, global const ShadeLight* lights,
                                  global const LIGHT_INDEX* list, uint count) {
    LightSum block = zero_sum();
    uint current = 0;
    for (uint i = 0; i < count; ++i) {
#if ALL_LIGHTS
        uint light = i;
#else
        uint light = list[i];
#endif
        if (light >> SUM_BLOCK_LOG2 != current) {
            current = light >> SUM_BLOCK_LOG2;
            total = add_sums(total, block);
            block = zero_sum();
        }
        block = evaluate(block, p, lights[light]);
    }
    return add_sums(total, block);
}

static inline FV3 select3(MASK mask, FV3 a, FV3 b) {
    return fv3(select_fv(mask, a.x, b.x), select_fv(mask, a.y, b.y), select_fv(mask, a.z, b.z));
}

static inline LightSum select_sum(MASK mask, LightSum a, LightSum b) {
    a.diffuse = select3(mask, a.diffuse, b.diffuse);
    a.specular = select3(mask, a.specular, b.specular);
    a.fresnel = select3(mask, a.fresnel, b.fresnel);
    return a;
}

kernel void shade(global const uchar* restrict gbuffer,
                  GBufferLayout layout,
                  View view,
                  global const float* restrict srgb,  // [256]
                  global const DirectionalLight* restrict directional_lights,  // [directional_count], view space
                  uint directional_count,
                  global const ShadeLight* restrict lights,  // [light_count], view space
                  uint light_count,
                  ClusterGrid grid,
                  global const uint* restrict cluster_offsets,    // [tiles + 1]
                  global const ActiveCluster* restrict clusters,  // [cluster_capacity]
                  uint cluster_capacity,
                  global const LIGHT_INDEX* restrict lists,
                  float ambient,
                  global float* restrict radiance) {  // out [3][height][stride]
    uint x = (uint)get_global_id(0) * VW;
    uint y = get_global_id(1);
    if (y >= view.height) return;
    GBuffer g = {gbuffer, layout, view, srgb};
    FV depth01 = load_depth01(g, x, y);
    MASK drawn = full_mask((depth01 > fv(0.0f)) & ((lane_numbers + x) < (UV)(view.width)));
    FV3 color = zero3();
    if (any_lane(drawn)) {
        FV z = view_depth(view, pixel_centers_x(x), fv((float)y + 0.5f), select_fv(drawn, depth01, fv(1.0f)));
        Surface s = load_surface(g, x, y, z);
        ShadingPoint p = make_shading_point(s, view.orthographic != 0u);
        LightSum sum = zero_sum();
#if HAS_DIRECTIONAL_LIGHTS
        for (uint i = 0; i < directional_count; ++i) sum = evaluate_directional(sum, p, directional_lights[i]);
#endif
#if ALL_LIGHTS
        sum = sum_lights(sum, p, lights, lists, light_count);
#else
        UV slice = slice_of_depth(grid, z);
        uint tile = y / FINE_TILE * ((view.width + FINE_TILE - 1) / FINE_TILE) + x / FINE_TILE;
        uint end = min(cluster_offsets[tile + 1], cluster_capacity);
        LightSum unlit = sum;
        for (uint i = cluster_offsets[tile]; i < end; ++i) {
            MASK mine = full_mask(slice == (UV)(clusters[i].slice)) & drawn;
            if (!any_lane(mine)) continue;
            LightSum lit = sum_lights(unlit, p, lights, lists + clusters[i].list_begin, clusters[i].list_count);
            sum = select_sum(mine, lit, sum);
        }
#endif
        color = select3(drawn, finish_shading(s, sum, ambient), color);
    }
    uint pixel = y * view.stride + x;
    uint plane = view.stride * view.height;
    store_lanes(color.x, radiance + pixel);
    store_lanes(color.y, radiance + plane + pixel);
    store_lanes(color.z, radiance + 2 * plane + pixel);
}
