// SPDX-License-Identifier: Apache-2.0
// Which pixels of each active cluster see each light of its list, as bits.
//   cast_shadows_reserve  words that the clusters of each tile need
//   (prefix_sum over tiles)
//   cast_shadows          one work-item casts the shadows of a tile: one walk for each cluster and
//                         light. For CPUs.
#define ORDERED_PIXELS 1
#define SHADOW_POINTS FINE_TILE_PIXELS
#include "kernels/shadows/cast_shadows.h"
#include "kernels/shadows/shadow_cast.h"

// The tile's pixels in the order of its clusters, as many as the planes have.
static inline void load_tile(global const float* origins, View view, uint tile,
                             global const uchar* order, ShadowPoints* points) {
    uint count = rows_of_tile(view, tile / fine_tiles_x(view)) * FINE_TILE;
    for (uint row = 0; row < count / VW; ++row) {
        load_origins(points, row, origins, view.stride * view.height,
                     pixels_of_tile(view, tile, row * VW, order));
    }
}

#if PICKED_ONLY
// The lanes of a row that pick the light.
static inline MASK drawn_lanes(global const uint* words, uint first, uint row) {
    uint word = words[row * VW / 32u - first / 32u] >> (row * VW % 32u);
    return lane_mask(((UV)(word) >> lane_numbers & 1u) != (UV)(0u));
}
#endif

// One light's bits of one cluster: its pixels in the tile's order are first .. end - 1.
static inline void cast_light(ShadowScene scene, ShadowLight light, uint first, uint end,
                              ShadowPoints* points, global uint* words) {
    uint first_row = first / VW;
    uint end_row = (end + VW - 1) / VW;
#if PICKED_ONLY
    uint picked = 0u;
    for (uint word = 0; word < shadow_words(first, end); ++word) picked |= words[word];
    if (picked == 0u) return;
#endif
    ulong tests_before = counted_tests(points);
    uint rays = 0, seen = 0;
    LaneBox box = {splat3((float3)(SHADOW_NOWHERE)), splat3((float3)(-SHADOW_NOWHERE))};
    MASK any = (MASK)(0);
    for (uint row = first_row; row < end_row; ++row) {
        UV place = lane_numbers + row * VW;
        MASK mine = lane_mask(place >= (UV)(first)) & lane_mask(place < (UV)(end));
#if PICKED_ONLY
        mine &= drawn_lanes(words, first, row);
#endif
        MASK lit = face_light(points, row, light, mine);
        box = grown_box(box, lit, load_points(points, row));
        any |= lit;
        rays += lane_count(lit);
    }
    if (lane_any(any)) {
        float3 low = (float3)(lane_min(box.low.x), lane_min(box.low.y), lane_min(box.low.z));
        float3 high = (float3)(lane_max(box.high.x), lane_max(box.high.y), lane_max(box.high.z));
        cast_shadows_of(scene, light, low, high, first_row, end_row, points);
    }
#if !PICKED_ONLY
    for (uint word = 0; word < shadow_words(first, end); ++word) words[word] = 0u;
#endif
    if (!lane_any(any)) return;
    for (uint row = first_row; row < end_row; ++row) {
        uint bits = lane_ballot(lit_of(points, row)) << (row * VW % 32u);
        seen += popcount(bits);
#if PICKED_ONLY
        words[row * VW / 32u - first / 32u] &= ~bits;
#else
        words[row * VW / 32u - first / 32u] |= bits;
#endif
    }
    count_rays(points, tests_before, rays, seen);
}

kernel __attribute__((reqd_work_group_size(1, 1, 1))) void cast_shadows(
    LIT_ARGS, SHADOW_ARGS, WORD_ARGS(),
    global ShadowCounts* restrict counts) {  // out [tiles] with COUNT_SHADOWS, where the tile has
                                             // lights
    uint tile = get_global_id(0);
    if (word_offsets[tile] == word_offsets[tile + 1]) return;
    ShadowScene scene = SHADOW_SCENE_OF_ARGS;
    Clusters active = CLUSTERS_OF_ARGS;
    ShadowPoints points;
    reset_counts(&points);
    load_tile(origins, view, tile, order, &points);
    global uint* out = words + word_offsets[tile];
    uint first = 0;
    FOR_EACH_CLUSTER(i, active, tile) {
        uint last = first + clusters[i].pixel_count;
        for (uint j = 0; j < directional_count + clusters[i].list_count; ++j) {
            ShadowLight light = light_of_cluster(shadow, clusters + i, j, directional_lights,
                                                 directional_count, lights, lists);
            cast_light(scene, light, first, last, &points, out);
            out += shadow_words(first, last);
        }
        first = last;
    }
#if COUNT_SHADOWS
    counts[tile] = points.counts;
#endif
}
