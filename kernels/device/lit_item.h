// SPDX-License-Identifier: Apache-2.0
// The beginning of kernels of lit pixels: the pixels of a work-item, those of them with surfaces,
// and their active clusters.
#ifndef KILOLUX_DEVICE_LIT_ITEM_H
#define KILOLUX_DEVICE_LIT_ITEM_H
#include "kernels/device/arguments.h"
#include "kernels/device/gbuffer.h"

#define GBUFFER_OF_ARGS ((GBuffer){gbuffer, layout, view, srgb})

// Active clusters by fine tile.
typedef struct Clusters {
    ClusterGrid grid;
    global const uint* offsets;
    global const ActiveCluster* clusters;
    uint capacity;
    global const uchar* order;
} Clusters;
#define CLUSTERS_OF_ARGS ((Clusters){grid, cluster_offsets, clusters, cluster_capacity, order})

// A loop over the active clusters `i` of a tile; clusters beyond the capacity are left out.
#define FOR_EACH_CLUSTER(i, from, tile)                                   \
    for (uint i = (from).offsets[tile],                                   \
              i##_end = min((from).offsets[(tile) + 1], (from).capacity); \
         i < i##_end; ++i)

static inline bool has_clusters(Clusters from, uint tile) {
    return from.offsets[tile] != from.offsets[tile + 1];
}

typedef struct LitItem {
    Pixels pixels;
    MASK shown;  // lanes with a surface
    bool any;    // whether there are some
    FV z;        // their depths [m]
    UV slice;    // their fine slices; of clustered items
} LitItem;

// The item of pixels that lie within the planes.
static inline LitItem lit_item(GBuffer g, Pixels pixels) {
    LitItem item;
    item.pixels = pixels;
    FV depth01 = load_depth01(g, pixels);
    item.shown = lane_mask(depth01 > fv(BACKGROUND_DEPTH)) & within_width(g.view, pixels);
    item.any = lane_any(item.shown);
    item.z = view_depth(g.view, pixels.x, pixels.y, lane_select(item.shown, depth01, fv(1.0f)));
    return item;
}

// lit_item() with the fine slices by which clusters are found.
static inline LitItem clustered_item(GBuffer g, ClusterGrid grid, Pixels pixels) {
    LitItem item = lit_item(g, pixels);
    item.slice = fine_slice_of_depth(grid, item.z);
    return item;
}

// The lanes that cluster i of the item's tile holds.
static inline MASK lanes_in_cluster(LitItem item, Clusters from, uint i) {
    return lane_mask(item.slice == (UV)(from.clusters[i].slice)) & item.shown;
}

// FOR_EACH_CLUSTER() of those that hold lanes of the item: `mine`. `break` and `continue` both go
// to the next cluster: use neither.
#define FOR_EACH_CLUSTER_OF(item, i, mine, from, tile) \
    FOR_EACH_CLUSTER(i, from, tile)                    \
    for (MASK mine = lanes_in_cluster(item, from, i); lane_any(mine); mine = (MASK)(0))

// How kernels of lit pixels begin: these macros declare, from the parameters, what follows. The
// G-buffer `g`, the work-item's place `at` and its `item` of pixels of a row; work-items below the
// planes end.
#define BEGIN_ROW                         \
    GBuffer g = GBUFFER_OF_ARGS;          \
    ItemPlace at = place_in_planes(view); \
    if (!at.inside) return;               \
    LitItem item = lit_item(g, row_pixels(view, at.x, at.y))
// The same with the clusters `active`.
#define BEGIN_CLUSTERED_ROW             \
    BEGIN_ROW;                          \
    Clusters active = CLUSTERS_OF_ARGS; \
    item.slice = fine_slice_of_depth(grid, item.z)
// The same of pixels in the order of the tile's clusters; work-items without a surface end, too.
#define BEGIN_ORDERED_ITEM                                                           \
    GBuffer g = GBUFFER_OF_ARGS;                                                     \
    Clusters active = CLUSTERS_OF_ARGS;                                              \
    ItemPlace at = place_in_planes(view);                                            \
    if (!at.inside || !has_clusters(active, at.tile)) return;                        \
    LitItem item = clustered_item(g, grid, pixels_of_item(view, at.x, at.y, order)); \
    if (!item.any) return
#endif
