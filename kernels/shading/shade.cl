// SPDX-License-Identifier: Apache-2.0
// Radiance of every pixel: the sum of evaluate() over the lights of its active cluster. With
// DISPLAYED its sRGB codes, the bits that tonemap makes of the radiance.
// One work-item shades VW pixels, neighbours in the order of their tile's clusters (bin_pixels). A
// work-group lies within one fine tile; with STAGE > 0 it is a whole one.
#define ORDERED_PIXELS 1
#include "kernels/device/lit_item.h"
#include "kernels/shading/light_target.h"
#include "kernels/shading/sum_lights.h"

// The inputs of lighting a tile by its clusters' lists.
typedef struct ClusterLists {
    Clusters clusters;
    global const LIGHT_INDEX* lists;
    global const DirectionalLight* directional;
    uint directional_count;
#if SHADOWS
    global const uint* shadows;  // cast_shadows' words of the tile
    uint place;                  // of the work-item's first pixel in the tile's order
#endif
} ClusterLists;

// The sum over the lights of a tile's clusters, each cluster's at the surface pixels of its slice.
// Without `any_shown` the work-item only helps to stage.
static inline LightSum sum_clusters(ClusterLists from, uint tile, LitItem item, bool any_shown,
                                    ShadingPoint p, LightSet set) {
#if !SHADOWS
    LightSum parallel = sum_directional(p, set, from.directional, from.directional_count);
#else
    LightSum parallel = zero_sum();  // each cluster has bits of its own
#endif
    LightSum sum = parallel;
    FOR_EACH_CLUSTER(i, from.clusters, tile) {
        global const ActiveCluster* cluster = from.clusters.clusters + i;
        MASK mine = lanes_in_cluster(item, from.clusters, i);
        bool wanted = any_shown && lane_any(mine);
#if SHADOWS
        if (wanted) {
            set.shadows = bits_of_cluster(from.shadows, cluster, from.place);
            parallel = sum_directional(p, set, from.directional, from.directional_count);
        }
#endif
        LightSum lit = sum_lights(parallel, wanted, p, set, from.lists + cluster->list_begin,
                                  cluster->list_count);
        if (wanted) sum = select_sum(mine, lit, sum);
    }
    return sum;
}

kernel void shade(LIT_ARGS, WORD_ARGS(const), SAMPLE_ARGS, OUTPUT_ARGS) {
    GBuffer g = GBUFFER_OF_ARGS;
    Clusters active = CLUSTERS_OF_ARGS;
    LightTarget to = LIGHT_TARGET_OF_ARGS;
    ItemPlace at = place_in_planes(view);
    LightSet set = light_set(lights, aimed_profiles, profile_tables);
#if STAGE > 0
    local ShadeLight staged_lights[STAGE];
    local uint staged_indices[STAGE];
    set.staged = staged_lights;
    set.staged_indices = staged_indices;
#else
    if (!at.inside) return;
#endif
    uint row = at.inside ? at.y : view.height - 1u;  // rows below the image only help to stage
    prefetch_next_tile(g, to, at.x, row);
    if (!has_clusters(active, at.tile)) {  // background, for the whole group
        if (at.inside) store_light(to, view, row_pixels(view, at.x, row), zero3());
        return;
    }
    LitItem item = clustered_item(g, active, pixels_of_item(view, at.x, row, order));
    bool any_shown = at.inside && item.any;
#if STAGE == 0
    if (!any_shown) {
        store_light(to, view, item.pixels, zero3());
        return;
    }
#endif
    Surface s = load_surface(g, item.pixels, item.z);
    ShadingPoint p = make_shading_point(s, view.orthographic != 0u);
    ClusterLists from = {active, lists, directional_lights, directional_count};
#if SHADOWS
    from.shadows = words + word_offsets[at.tile];
    from.place = place_of_item(at.x, row);
    set.directional_count = directional_count;
#endif
#if SAMPLED_SHADOWS
    FV spread = fv(0.0f);
    set.variance = &spread;
    set.pick = make_pick(s, whole, view, item.pixels, at.x, row, rays, seed);
#endif
    LightSum sum = sum_clusters(from, at.tile, item, any_shown, p, set);
#if SAMPLED_SHADOWS
    FV3 color = without_hidden(set.pick, load_radiance(whole, view, item.pixels), sum);
    if (at.inside) store_plane(variance, item.pixels, lane_select(item.shown, spread, fv(0.0f)));
#else
    FV3 color = finish_shading(s, sum, ambient);
#endif
    if (at.inside) store_light(to, view, item.pixels, select3(item.shown, color, zero3()));
}
