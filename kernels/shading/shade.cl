// SPDX-License-Identifier: Apache-2.0
// Radiance of every pixel: the sum of evaluate() over the lights of its active cluster. With
// DISPLAYED its sRGB codes, the bits that tonemap makes of the radiance.
// One work-item shades VW pixels, neighbours in the order of their tile's clusters (bin_pixels).
#define ORDERED_PIXELS 1
#include "kernels/device/lit_item.h"
#include "kernels/shading/sum_lights.h"

// With MARK_CANDIDATES the kernel of unshadowed light also marks, in cast_shadows' words, what
// pixels may pick.
#if MARK_CANDIDATES
#define WORDS_ACCESS
#else
#define WORDS_ACCESS const
#endif

// Lists of a tile's clusters.
typedef struct LightSource {
    Clusters clusters;
    global const LIGHT_INDEX* lists;
    global const DirectionalLight* directional;
    uint directional_count;
#if SHADOWS || MARK_CANDIDATES
    global const uint* word_offsets;  // WORD_ARGS
    uint word_capacity;
    global WORDS_ACCESS uint* words;
#endif
#if TINTED_SHADOWS
    global const float* origins;
    ShadowScene casters;
    global const TintCaster* tint_casters;
#endif
} LightSource;

#if STAGE > 0
// 1 if the work-group's rows have pixels at the places [first, end) of their tile's order, else 0;
// the same for all of its items.
static inline uint group_has_pixels(uint first, uint end) {
    uint rows = get_local_size(1);
    uint begin = get_group_id(1) * rows % FINE_TILE * FINE_TILE;
    return select(0u, 1u, first < begin + rows * FINE_TILE) & select(0u, 1u, begin < end);
}
#endif

static inline bool has_lights(LightSource from, uint tile) {
    return has_clusters(from.clusters, tile);
}

static inline LitItem source_item(LightSource from, GBuffer g, uint x, uint y) {
    return clustered_item(g, from.clusters.grid, pixels_of_item(g.view, x, y, from.clusters.order));
}

// The sum over the lights of a tile's clusters, each cluster's at the surface pixels of its slice.
static inline LightSum source_sum(LightSource from, GBuffer g, ItemPlace at, LitItem item,
                                  bool wanted, ShadingPoint p, LightSet set) {
#if !SHADOWS
    LightSum parallel = sum_directional(p, set, from.directional, from.directional_count);
#else
    LightSum parallel = zero_sum();  // each cluster has bits of its own
    set.directional_count = from.directional_count;
#endif
#if TINTED_SHADOWS
    ShadowPoints points;
    set.tints.scene = tinting_scene(from.casters, from.tint_casters);
    set.tints.points = &points;
    load_origins(&points, 0u, from.origins, g.view.stride * g.view.height, item.pixels);
#endif
    LightSum sum = parallel;
#if SHADOWS || MARK_CANDIDATES
    wanted = wanted && has_usable_words(from.word_offsets, from.word_capacity, at.tile,
                                        fine_tile_count(g.view));
#endif
#if STAGE > 0
    uint place = 0u;  // of the cluster's first pixel in the tile's order
#endif
    FOR_EACH_CLUSTER(i, from.clusters, at.tile) {
        global const ActiveCluster* cluster = from.clusters.clusters + i;
        uint count = cluster->list_count;
#if STAGE > 0
        // The whole group skips a cluster that has none of its pixels. A selection: PoCL 3.1 loses
        // values that branches made before barriers.
        uint end = place + cluster->pixel_count;
        count = select(0u, count, group_has_pixels(place, end));
        place = end;
#endif
        MASK mine = lanes_in_cluster(item, from.clusters, i);
        bool any_mine = wanted && lane_any(mine);
#if LIGHT_GROUPS
        set.mine = mine;
#endif
#if SHADOWS
        if (any_mine) {
            set.shadows = bits_of_cluster(from.words + from.word_offsets[at.tile], cluster,
                                          place_of_item(at.x, at.y));
            parallel = sum_directional(p, set, from.directional, from.directional_count);
        }
#endif
#if MARK_CANDIDATES
        set.candidates.bits = bits_of_cluster(from.words + from.word_offsets[at.tile], cluster,
                                              place_of_item(at.x, at.y));
        set.candidates.mine = mine;
#endif
        LightSum lit =
            sum_lights(parallel, any_mine, p, set, from.lists + cluster->list_begin, count);
        if (any_mine) sum = select_sum(mine, lit, sum);
    }
    return sum;
}

#include "kernels/shading/shade_item.h"

#if TINTED_SHADOWS
#define TINT_ARGS SHADOW_ARGS,
#else
#define TINT_ARGS
#endif

kernel void shade(LIT_ARGS, WORD_ARGS(WORDS_ACCESS), TINT_ARGS SAMPLE_ARGS, OUTPUT_ARGS) {
    LIGHT_SET_OF_ARGS(set);
    LightSource from = {CLUSTERS_OF_ARGS, lists, directional_lights, directional_count};
#if MARK_CANDIDATES
    set.candidates.words = words;
    set.candidates.directional_count = directional_count;
#endif
#if SHADOWS || MARK_CANDIDATES
    from.word_offsets = word_offsets;
    from.word_capacity = word_capacity;
    from.words = words;
#endif
#if TINTED_SHADOWS
    from.origins = origins;
    from.casters = SHADOW_SCENE_OF_ARGS;
    from.tint_casters = tint_casters;
#endif
    shade_item(GBUFFER_OF_ARGS, from, set, SHADE_OUTPUT_OF_ARGS);
}
