// SPDX-License-Identifier: Apache-2.0
// Results of culling: extents of lights on the coarse grid, active clusters and their lists.
#ifndef KILOLUX_SHARED_CLUSTERS_H
#define KILOLUX_SHARED_CLUSTERS_H
#include "kernels/shared/types.h"
#if defined(__cplusplus)
namespace kilolux {
#endif

// The part of the coarse grid that a light's sphere can touch; slice_first > slice_last: none.
SHARED_STRUCT(LightExtent) {
    uint slices;   // first | last << 16
    uint columns;  // first | last << 16, tiles in x
    uint rows;     // first | last << 16, tiles in y
    uint unused0;
};
SHARED_ASSERT(light_extent_size, sizeof(LightExtent) == 16);

// The pixels of one fine tile that lie in one fine slice, and the lights that reach their box.
SHARED_STRUCT(ActiveCluster) {
    float min_x, min_y, min_z;  // box of the pixels' positions in view space [m]
    uint slice;                 // fine_slice_of_depth
    float max_x, max_y, max_z;
    uint pixel_count;
    uint list_begin;  // in the refined list
    uint list_count;
    uint first_pixel;  // in the tile's order; set where shadows are cast
    uint first_word;   // of its shadows' bits among the tile's; likewise
};
SHARED_ASSERT(active_cluster_size, sizeof(ActiveCluster) == 48);

#if !defined(GL_core_profile)  // GLSL has no 64-bit integers
// The counts of a frame's lists. The first three decide whether the lists are complete.
SHARED_STRUCT(PairCounts) {
    ulong coarse_pairs;     // entries of the coarse lists
    ulong active_clusters;  // of all fine tiles
    ulong refine_tests;     // lights tested, once for each active cluster
    ulong refined_pairs;    // entries of the refined lists
    ulong surface_pixels;   // pixels of the active clusters, those with a surface
    ulong evaluations;      // sum over active clusters of list_count * pixel_count
};
SHARED_ASSERT(pair_counts_size, sizeof(PairCounts) == 48);
#endif

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
