// SPDX-License-Identifier: Apache-2.0
// Radiance of every pixel: the sum of evaluate() over the lights of its active cluster. With
// DISPLAYED its sRGB codes, the bits that tonemap makes of the radiance.
// One work-item shades VW pixels, neighbours in the order of their tile's clusters (bin_pixels). A
// work-group lies within one fine tile; with STAGE > 0 it is a whole one.
#define ORDERED_PIXELS 1
#include "kernels/device/gbuffer.h"
#include "kernels/shading/light_target.h"
#include "kernels/shading/sum_lights.h"
#include "kernels/shared/cluster_grid.h"
#include "kernels/shared/clusters.h"

#if !SHADOWS
static inline LightSum select_sum(MASK mask, LightSum a, LightSum b) {
    a.diffuse = select3(mask, a.diffuse, b.diffuse);
    a.specular = select3(mask, a.specular, b.specular);
    return a;
}
#endif

// Active clusters by fine tile, and their lists.
typedef struct ClusterLists {
    global const uint* offsets;
    global const ActiveCluster* clusters;
    uint capacity;  // of clusters
    global const LIGHT_INDEX* lists;
    global const DirectionalLight* directional;
    uint directional_count;
#if SHADOWS
    global const uint* shadows;  // cast_shadows' words of the tile
    uint place;                  // of the work-item's first pixel in the tile's order
#endif
} ClusterLists;

// What the lights of a tile's clusters add up to, each cluster's at the drawn pixels of its slice.
// `any_drawn`: else the work-item only helps to stage.
static inline LightSum sum_clusters(ClusterLists from, uint tile, UV slice, MASK drawn,
                                    bool any_drawn, ShadingPoint p, LightSet set) {
#if !SHADOWS
    LightSum unlit = sum_directional(p, set, from.directional, from.directional_count);
    LightSum sum = unlit;
#else
    LightSum unlit = zero_sum();
    LightSum sum = unlit;
#endif
    uint end = min(from.offsets[tile + 1], from.capacity);
    for (uint i = from.offsets[tile]; i < end; ++i) {
        MASK mine = lane_mask(slice == (UV)(from.clusters[i].slice)) & drawn;
        bool wanted = any_drawn && lane_any(mine);
#if SHADOWS
        if (wanted) {
            set.shadows = bits_of_cluster(from.shadows, from.clusters + i, from.place);
            unlit = sum_directional(p, set, from.directional, from.directional_count);
        }
#endif
        LightSum lit = sum_lights(unlit, wanted, p, set, from.lists + from.clusters[i].list_begin,
                                  from.clusters[i].list_count);
        if (wanted) sum = select_sum(mine, lit, sum);
    }
    return sum;
}

kernel void shade(
    global const uchar* restrict gbuffer, GBufferLayout layout, View view,
    global const float* restrict srgb,                           // [256]
    global const DirectionalLight* restrict directional_lights,  // [directional_count], view space
    uint directional_count,
    global const StoredLight* restrict lights,  // [light_count], view space
#if HAS_LIGHT_PROFILES
    global const AimedProfile* restrict aimed_profiles,  // [light_count], view space
    global const float* restrict profile_tables,
#endif
    ClusterGrid grid,
    global const uint* restrict cluster_offsets,    // [tiles + 1]
    global const ActiveCluster* restrict clusters,  // [cluster_capacity]
    uint cluster_capacity,
    global const uchar* restrict order,  // [tiles][FINE_TILE_PIXELS]
    global const LIGHT_INDEX* restrict lists, float ambient,
#if SHADOWS
    global const uint* restrict shadow_offsets,  // [tiles + 1]
    global const uint* restrict shadow_words_of_tiles,
#endif
#if SAMPLED_SHADOWS
    global const float* restrict whole,  // [3][height][stride]: radiance if all lights are seen
    float rays, uint seed,
    global float* restrict variance,  // out [height][stride]: of the luminance, its estimate
#endif
#if DISPLAYED
    float gain,
    global const float* restrict bucket_boundary,  // [SRGB_BUCKETS]
    global const uint* restrict bucket_code,       // [SRGB_BUCKETS]
    global uint* restrict display) {               // out [height][stride]: see display.h
    LightTarget to = {display, {gain, bucket_boundary, bucket_code}};
#else
    global float* restrict radiance) {  // out [3][height][stride]
    LightTarget to = {radiance};
#endif
    uint x = (uint)get_global_id(0) * VW;
    uint y = get_global_id(1);
    bool inside = y < view.height;
    LightSet set;
    set.lights = lights;
#if HAS_LIGHT_PROFILES
    set.profiles = (LightProfiles){aimed_profiles, profile_tables};
#endif
#if STAGE > 0
    local ShadeLight staged_lights[STAGE];
    local uint staged_indices[STAGE];
    set.staged = staged_lights;
    set.staged_indices = staged_indices;
#else
    if (!inside) return;
#endif
    uint row = inside ? y : view.height - 1u;  // rows below the image only help to stage
    GBuffer g = {gbuffer, layout, view, srgb};
    prefetch_next_tile(g, to, x, row);
    uint tile = fine_tile_of(view, x, y);
    if (cluster_offsets[tile] == cluster_offsets[tile + 1]) {  // background, for the whole group
        if (inside) store_light(to, view, row_pixels(view, x, row), zero3());
        return;
    }
    Pixels pixels = pixels_of_item(view, x, row, order);
    FV depth01 = load_depth01(g, pixels);
    MASK drawn = lane_mask(depth01 > fv(0.0f)) & within_width(view, pixels);
    bool any_drawn = inside && lane_any(drawn);
#if STAGE == 0
    if (!any_drawn) {
        store_light(to, view, pixels, zero3());
        return;
    }
#endif
    FV z = view_depth(view, pixels.x, pixels.y, lane_select(drawn, depth01, fv(1.0f)));
    Surface s = load_surface(g, pixels, z);
    ShadingPoint p = make_shading_point(s, view.orthographic != 0u);
    ClusterLists from = {cluster_offsets, clusters,           cluster_capacity,
                         lists,           directional_lights, directional_count};
#if SHADOWS
    from.shadows = shadow_words_of_tiles + shadow_offsets[tile];
    from.place = place_of_item(x, row);
    set.directional_count = directional_count;
#endif
#if SAMPLED_SHADOWS
    FV spread = fv(0.0f);
    set.variance = &spread;
    set.draw = make_draw(s, whole, view, pixels, x, row, rays, seed);
#endif
    LightSum sum = sum_clusters(from, tile, fine_slice_of_depth(grid, z), drawn, any_drawn, p, set);
#if SAMPLED_SHADOWS
    FV3 color = without_hidden(set.draw, load_radiance(whole, view, pixels), sum);
#else
    FV3 color = finish_shading(s, sum, ambient);
#endif
    if (inside) store_light(to, view, pixels, select3(drawn, color, zero3()));
#if SAMPLED_SHADOWS
    if (inside) store_plane(variance, pixels, lane_select(drawn, spread, fv(0.0f)));
#endif
}
