// SPDX-License-Identifier: Apache-2.0
// Which pixels of each active cluster see each light of its list, as bits.
//   cast_shadows_reserve  words that the clusters of each tile need
//   (prefix_sum over tiles)
//   cast_shadows          one work-item casts the shadows of a tile: one walk for each cluster and
//                         light. For CPUs.
#define ORDERED_PIXELS 1
#define SHADOW_POINTS FINE_TILE_PIXELS
#include "kernels/shadows/area_rays.h"
#include "kernels/shadows/cast_shadows.h"
#include "kernels/shadows/shadow_cast.h"

// The tile's pixels in the order of its clusters, as many as the planes have.
static inline void load_tile(GBuffer g, global const float* origins, uint tile,
                             global const uchar* order, ShadowPoints* points) {
    View view = g.view;
    uint count = rows_of_tile(view, tile / fine_tiles_x(view)) * FINE_TILE;
    for (uint row = 0; row < count / VW; ++row) {
        Pixels pixels = pixels_of_tile(view, tile, row * VW, order);
        load_origins(points, row, origins, view.stride * view.height, pixels);
        load_area_pixels(points, row, g, pixels);
    }
}

#if PICKED_ONLY
// The lanes of a row that pick the light.
static inline MASK drawn_lanes(global const uint* words, uint first, uint row) {
    uint word = words[row * VW / 32u - first / 32u] >> (row * VW % 32u);
    return lane_mask(((UV)(word) >> lane_numbers & 1u) != (UV)(0u));
}
#endif

// Bits of a light in the words of a cluster whose pixels are first .. end - 1 in the tile's order.
typedef struct ClusterBits {
    uint first, end;
    global uint* words;
} ClusterBits;

static inline MASK wanted_lanes(ClusterBits bits, uint row) {
    UV place = lane_numbers + row * VW;
    MASK mine = lane_mask(place >= (UV)(bits.first)) & lane_mask(place < (UV)(bits.end));
#if PICKED_ONLY
    mine &= drawn_lanes(bits.words, bits.first, row);
#endif
    return mine;
}

// Sets the bits of lit points, of words that are 0; or clears them in those of picked lights. The
// number of lit points.
static inline uint put_lit(ClusterBits bits, uint first_row, uint end_row,
                           const ShadowPoints* points) {
    uint seen = 0;
    for (uint row = first_row; row < end_row; ++row) {
        uint lit = lane_ballot(lit_of(points, row)) << (row * VW % 32u);
        seen += popcount(lit);
#if PICKED_ONLY
        bits.words[row * VW / 32u - bits.first / 32u] &= ~lit;
#else
        bits.words[row * VW / 32u - bits.first / 32u] |= lit;
#endif
    }
    return seen;
}

// One light's bits.
static inline void cast_light(ShadowScene scene, ShadowLight light, ClusterBits bits,
                              ShadowPoints* points) {
    uint first_row = bits.first / VW;
    uint end_row = (bits.end + VW - 1) / VW;
    ulong tests_before = counted_tests(points);
    uint rays = 0;
    LaneBox box = no_box();
    MASK any = (MASK)(0);
    for (uint row = first_row; row < end_row; ++row) {
        MASK lit = face_light(scene.view, points, row, light, wanted_lanes(bits, row));
        box = grown_box(box, lit, load_points(points, row));
        any |= lit;
        rays += lane_count(lit);
    }
    if (lane_any(any)) {
        cast_shadows_of(scene, light, box_low(box), box_high(box), first_row, end_row, points);
    }
#if !PICKED_ONLY
    uint count = shadow_words(bits.first, bits.end);
    for (uint word = 0; word < count; ++word) bits.words[word] = 0u;
#endif
    if (!lane_any(any)) return;
    count_rays(points, tests_before, rays, put_lit(bits, first_row, end_row, points));
}

kernel __attribute__((reqd_work_group_size(1, 1, 1))) void cast_shadows(
    LIT_ARGS, SHADOW_ARGS, TARGET_ARGS, SAMPLE_ARGS,
    global ShadowCounts* restrict counts) {  // out [tiles] with COUNT_SHADOWS, where the tile has
                                             // lights
    uint tile = get_global_id(0);
    if (!HAS_USABLE_WORDS(tile)) return;
    ShadowScene scene = SHADOW_SCENE_OF_ARGS;
    Clusters active = CLUSTERS_OF_ARGS;
    ShadowPoints points;
    reset_counts(&points);
    load_tile(GBUFFER_OF_ARGS, origins, tile, order, &points);
#if AREA_SHADOWS
    AreaRays area_rays;
    reset_counts(&area_rays.ends);
#endif
    CastLights from = CAST_LIGHTS_OF_ARGS;
    uint key = key_of_tile(view, from, tile);
    ClusterBits bits = {0u, 0u, words + word_offsets[tile]};
    FOR_EACH_CLUSTER(i, active, tile) {
        bits.end = bits.first + clusters[i].pixel_count;
        uint count = shadow_words(bits.first, bits.end);
        global uint* cluster_words = bits.words;
        for (uint j = 0; j < count_of_cluster(from, clusters + i); ++j) {
            bits.words = cluster_words + slots_before(from, j) * count;
#if PICKED_ONLY
            if (!is_picked_by_any(from, j, bits.words, count)) continue;
#else
            if (is_kept(kept, (uint)(bits.words - words))) continue;
#endif
            ShadowLight light = light_of_cluster(from, shadow, clusters + i, j, key);
#if AREA_SHADOWS
            if (light.is_area) {
                SlotWords to = {bits.words, count, bits.first / 32u * 32u};
                cast_area_light(scene, light, from, to, &points, &area_rays);
                continue;
            }
#endif
            cast_light(scene, light, bits, &points);
        }
        bits.words =
            cluster_words + slots_before(from, count_of_cluster(from, clusters + i)) * count;
        bits.first = bits.end;
    }
#if AREA_SHADOWS
    add_counts(&points, &area_rays.ends);
#endif
#if COUNT_SHADOWS
    counts[tile] = points.counts;
#endif
}
