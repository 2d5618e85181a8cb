// SPDX-License-Identifier: Apache-2.0
// Radiance of every pixel: the sum of evaluate() over the lights of its active cluster, or, with
// ALL_LIGHTS, over every light (the reference that lists must not change by a bit).
// One work-item shades VW pixels: neighbours in the order of their tile's clusters (bin_pixels) or,
// with ALL_LIGHTS, in a row. A work-group lies within one fine tile.
// NATIVE_MATH: roots and quotients as the device's hardware makes them, of unstated accuracy.
#if NATIVE_MATH
#undef sqrt
#undef rsqrt
#define sqrt native_sqrt
#define rsqrt native_rsqrt
#define DIVIDE(a, b) ((a)*native_recip(b))
#endif
#ifndef ALL_LIGHTS
#define ALL_LIGHTS 0
#endif
#define ORDERED_PIXELS (!ALL_LIGHTS)
#include "kernels/device/gbuffer.h"
#include "kernels/device/light_index.h"
#include "kernels/shared/cluster_grid.h"
#include "kernels/shared/clusters.h"

#ifndef HAS_DIRECTIONAL_LIGHTS
#define HAS_DIRECTIONAL_LIGHTS 0
#endif
// Lights that a work-group stages in local memory at a time; 0: none. Then work-groups are whole
// tiles.
#ifndef STAGE
#define STAGE 0
#endif
#if STAGE > 0
#define STAGED_PARAMETER , Staged staged
#define STAGED_ARGUMENT , staged
#else
#define STAGED_PARAMETER
#define STAGED_ARGUMENT
#endif

#if HALF_LIGHT_COLORS
// A light with its colour in half precision over a power of two, so that no intensity overflows: 32
// bytes instead of 48 without spot lights.
typedef struct StoredLight {
    float4 position_inv_range2;
    // xy: half4 of the colour / z; z: that power of two; w: 1/(cos_in - cos_out)
    uint4 color_scale;
#if HAS_SPOT_LIGHTS
    float4 axis_cos;
#endif
} StoredLight;

static inline ShadeLight load_light(global const StoredLight* stored) {
    ShadeLight light;
    light.position_inv_range2 = stored->position_inv_range2;
    light.color_scale =
        vload_half4(0, (global const half*)&stored->color_scale) * as_float(stored->color_scale.z);
    light.color_scale.w = as_float(stored->color_scale.w);
#if HAS_SPOT_LIGHTS
    light.axis_cos = stored->axis_cos;
#endif
    return light;
}
#define LIGHT_AT(lights, i) load_light((lights) + (i))

kernel void store_lights(global const ShadeLight* restrict lights,
                         global StoredLight* restrict stored) {
    uint i = get_global_id(0);
    float4 c = lights[i].color_scale;
    float unit = ldexp(1.0f, clamp(ilogb(max(c.x, max(c.y, c.z))), -126, 126));
    stored[i].position_inv_range2 = lights[i].position_inv_range2;
    stored[i].color_scale.zw = as_uint2((float2)(unit, c.w));
    vstore_half4_rte((float4)(c.xyz / unit, 0.0f), 0, (global half*)&stored[i].color_scale);
#if HAS_SPOT_LIGHTS
    stored[i].axis_cos = lights[i].axis_cos;
#endif
}
#else
typedef ShadeLight StoredLight;
#define LIGHT_AT(lights, i) (lights)[i]
#endif

// A sum over lights in progress: blocks by light index (SUM_BLOCK_LOG2) join the total one by one.
typedef struct RunningSum {
    LightSum total, block;
    uint block_number;
} RunningSum;

static inline RunningSum start_sum(LightSum total) {
    RunningSum sum;
    sum.total = total;
    sum.block = zero_sum();
    sum.block_number = 0u;
    return sum;
}

// The sum as light `index` joins it: a new block where the index enters one.
static inline RunningSum enter_block(RunningSum sum, uint index) {
    uint block_number = index >> SUM_BLOCK_LOG2;
    if (block_number != sum.block_number) {
        sum.block_number = block_number;
        sum.total = add_sums(sum.total, sum.block);
        sum.block = zero_sum();
    }
    return sum;
}

static inline uint light_of_entry(global const LIGHT_INDEX* list, uint entry) {
#if ALL_LIGHTS
    return entry;
#else
    return list[entry];
#endif
}

#if STAGE > 0
// Lights of a batch in local memory, which GPUs read faster than global memory through its cache.
typedef struct Staged {
    local ShadeLight* lights;
    local uint* indices;
} Staged;

static inline void stage_batch(Staged staged, global const StoredLight* lights,
                               global const LIGHT_INDEX* list, uint first, uint end) {
    uint item = get_local_id(1) * get_local_size(0) + get_local_id(0);
    uint items = get_local_size(0) * get_local_size(1);
    for (uint i = item; first + i < end; i += items) {
        uint light = light_of_entry(list, first + i);
        staged.indices[i] = light;
        staged.lights[i] = LIGHT_AT(lights, light);
    }
}
#endif

// Adds the lights of list[0..count), or lights 0..count with ALL_LIGHTS, where `wanted`. The whole
// work-group calls this with the same list: it may stage the lights together.
static inline LightSum sum_lights(LightSum total, bool wanted, ShadingPoint p,
                                  global const StoredLight* lights, global const LIGHT_INDEX* list,
                                  uint count STAGED_PARAMETER) {
    RunningSum sum = start_sum(total);
#if STAGE > 0
    for (uint first = 0; first < count; first += STAGE) {
        uint end = min(first + STAGE, count);
        barrier(CLK_LOCAL_MEM_FENCE);  // the batch before is used up
        stage_batch(staged, lights, list, first, end);
        barrier(CLK_LOCAL_MEM_FENCE);  // the batch is complete
        for (uint i = 0; wanted && i < end - first; ++i) {
            sum = enter_block(sum, staged.indices[i]);
            sum.block = evaluate(sum.block, p, staged.lights[i]);
        }
    }
#else
    if (!wanted) return total;
    for (uint i = 0; i < count; ++i) {
        uint light = light_of_entry(list, i);
        sum = enter_block(sum, light);
        sum.block = evaluate(sum.block, p, LIGHT_AT(lights, light));
    }
#endif
    return add_sums(sum.total, sum.block);
}

static inline FV3 select3(MASK mask, FV3 a, FV3 b) {
    return fv3(select_fv(mask, a.x, b.x), select_fv(mask, a.y, b.y), select_fv(mask, a.z, b.z));
}

static inline LightSum select_sum(MASK mask, LightSum a, LightSum b) {
    a.diffuse = select3(mask, a.diffuse, b.diffuse);
    a.specular = select3(mask, a.specular, b.specular);
    return a;
}

static inline void store_plane(global float* plane, Pixels pixels, FV value) {
#if ORDERED_PIXELS
    if (!pixels.in_row) {
        float lanes[VW];
        store_lanes(value, lanes);
        for (uint i = 0; i < VW; ++i) plane[pixels.place[i]] = lanes[i];
        return;
    }
#endif
    store_lanes(value, plane + pixels.first);
}

static inline void store_radiance(global float* radiance, View view, Pixels pixels, FV3 color) {
    uint plane = view.stride * view.height;
    store_plane(radiance, pixels, color.x);
    store_plane(radiance + plane, pixels, color.y);
    store_plane(radiance + 2 * plane, pixels, color.z);
}

// Asks for the row's pixels in the tile to the right, which a CPU's thread shades next.
static inline void prefetch_next_tile(GBuffer g, global float* radiance, uint x, uint y) {
    uint place = y * g.view.stride + x + FINE_TILE;
    uint plane = g.view.stride * g.view.height;
    prefetch_surface(g, place);
    prefetch_to_write(radiance + place);
    prefetch_to_write(radiance + plane + place);
    prefetch_to_write(radiance + 2 * plane + place);
}

kernel void shade(
    global const uchar* restrict gbuffer, GBufferLayout layout, View view,
    global const float* restrict srgb,                           // [256]
    global const DirectionalLight* restrict directional_lights,  // [directional_count], view space
    uint directional_count,
    global const StoredLight* restrict lights,  // [light_count], view space
    uint light_count, ClusterGrid grid,
    global const uint* restrict cluster_offsets,    // [tiles + 1]
    global const ActiveCluster* restrict clusters,  // [cluster_capacity]
    uint cluster_capacity,
    global const uchar* restrict order,  // [tiles][FINE_TILE_PIXELS]
    global const LIGHT_INDEX* restrict lists, float ambient,
    global float* restrict radiance) {  // out [3][height][stride]
    uint x = (uint)get_global_id(0) * VW;
    uint y = get_global_id(1);
    bool inside = y < view.height;
#if STAGE > 0
    local ShadeLight staged_lights[STAGE];
    local uint staged_indices[STAGE];
    Staged staged = {staged_lights, staged_indices};
#else
    if (!inside) return;
#endif
    uint row = inside ? y : view.height - 1u;  // rows below the image only help to stage
    GBuffer g = {gbuffer, layout, view, srgb};
    prefetch_next_tile(g, radiance, x, row);
#if ALL_LIGHTS
    Pixels pixels = row_pixels(view, x, row);
#else
    uint tile = y / FINE_TILE * ((view.width + FINE_TILE - 1) / FINE_TILE) + x / FINE_TILE;
    if (cluster_offsets[tile] == cluster_offsets[tile + 1]) {  // background, for the whole group
        if (inside) store_radiance(radiance, view, row_pixels(view, x, row), zero3());
        return;
    }
    Pixels pixels = ordered_pixels(
        view, x / FINE_TILE * FINE_TILE, y / FINE_TILE * FINE_TILE,
        order + tile * FINE_TILE_PIXELS + row % FINE_TILE * FINE_TILE + x % FINE_TILE);
#endif
    FV depth01 = load_depth01(g, pixels);
    MASK drawn = full_mask(depth01 > fv(0.0f)) & within_width(view, pixels);
    bool any_drawn = inside && any_lane(drawn);
#if STAGE == 0
    if (!any_drawn) {
        store_radiance(radiance, view, pixels, zero3());
        return;
    }
#endif
    FV z = view_depth(view, pixels.x, pixels.y, select_fv(drawn, depth01, fv(1.0f)));
    Surface s = load_surface(g, pixels, z);
    ShadingPoint p = make_shading_point(s, view.orthographic != 0u);
    LightSum sum = zero_sum();
#if HAS_DIRECTIONAL_LIGHTS
    for (uint i = 0; i < directional_count; ++i)
        sum = evaluate_directional(sum, p, directional_lights[i]);
#endif
#if ALL_LIGHTS
    sum = sum_lights(sum, any_drawn, p, lights, lists, light_count STAGED_ARGUMENT);
#else
    UV slice = fine_slice_of_depth(grid, z);
    uint end = min(cluster_offsets[tile + 1], cluster_capacity);
    LightSum unlit = sum;
    for (uint i = cluster_offsets[tile]; i < end; ++i) {
        MASK mine = full_mask(slice == (UV)(clusters[i].slice)) & drawn;
        bool wanted = any_drawn && any_lane(mine);
        LightSum lit = sum_lights(unlit, wanted, p, lights, lists + clusters[i].list_begin,
                                  clusters[i].list_count STAGED_ARGUMENT);
        if (wanted) sum = select_sum(mine, lit, sum);
    }
#endif
    FV3 color = finish_shading(s, sum, ambient);
    if (inside) store_radiance(radiance, view, pixels, select3(drawn, color, zero3()));
}
