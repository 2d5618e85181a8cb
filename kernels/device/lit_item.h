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

// The first pixel of a work-item and its tile. A work-item below the planes has none.
typedef struct ItemPlace {
    uint x, y;
    bool inside;
    uint tile;
} ItemPlace;

static inline ItemPlace place_in_planes(View view) {
    ItemPlace at;
    at.x = (uint)get_global_id(0) * VW;
    at.y = get_global_id(1);
    at.inside = at.y < view.height;
    at.tile = fine_tile_of(view, at.x, at.y);
    return at;
}

// lit_item() with the fine slices by which clusters are found.
static inline LitItem clustered_item(GBuffer g, Clusters from, Pixels pixels) {
    LitItem item = lit_item(g, pixels);
    item.slice = fine_slice_of_depth(from.grid, item.z);
    return item;
}

// The lanes that cluster i of the item's tile holds.
static inline MASK lanes_in_cluster(LitItem item, Clusters from, uint i) {
    return lane_mask(item.slice == (UV)(from.clusters[i].slice)) & item.shown;
}

#if ORDERED_PIXELS
// The item's pixels in the order of its tile's clusters; `any` is also false without clusters.
static inline LitItem ordered_item(GBuffer g, Clusters from, ItemPlace at) {
    if (!at.inside || !has_clusters(from, at.tile)) {
        LitItem none;
        none.any = false;
        return none;
    }
    return clustered_item(g, from, pixels_of_item(g.view, at.x, at.y, from.order));
}
#endif
#endif
