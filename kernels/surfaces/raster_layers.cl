// SPDX-License-Identifier: Apache-2.0
// Tiles' triangles -> one layer of surfaces after the other, from far to near, of a rectangle of
// the picture. A layer holds at each pixel the farthest fragment that is nearer than the last
// layer's. Of fragments of equal depth the one with the smaller triangle number counts as nearer,
// as in raster_triangles. Layers lie below each other in the planes of ids, each of `layer_rows`
// rows, of which those beyond the rectangle are empty. One work-item has VW neighbours of a row.
#include "kernels/device/arguments.h"
#include "kernels/device/gbuffer.h"
#include "kernels/surfaces/raster_tile.h"
#include "kernels/surfaces/raster_triangle.h"

// The key of the surface behind all layers; the far plane's where there is none.
kernel void raster_layers_begin(
    GBUFFER_ARGS,                 // what lies behind, in planes that hold the rectangle
    View region,                  // the rectangle
    global float* restrict keys,  // out [height][stride] of `region`
    uint count,
    global uint* restrict drawn) {  // out [count]: 0
    ItemPlace at = place_in_planes(region);
    if (at.x + at.y == 0u) {
        for (uint i = 0; i < count; ++i) drawn[i] = 0u;
    }
    if (!at.inside) return;
    GBuffer g = {gbuffer, layout, view, srgb};
    Pixels pixels = row_pixels(view, plane_column(view, picture_column(region, at.x)),
                               plane_row(view, picture_row(region, at.y)));
    FV behind = far_key(view, pixels.x, pixels.y);
    lane_store(fma(load_depth01(g, pixels), fv(near_from_far(view)), behind),
               keys + row_pixels(region, at.x, at.y).first);
}

static inline FV along(global const float* e, FV x, float y) {
    return fma(fv(e[0]), x, fv(fma(e[1], y, -e[2])));
}

// Integers decide where floats are uncertain.
static inline MASK decide_exactly(SurfaceScene scene, View view, uint number, MASK unsure, FV ray_x,
                                  float ray_y) {
    ExactTriangle t = exact_triangle(scene, view, number);
    float x[VW];
    int out[VW];
    lane_store(ray_x, x);
    lane_store(unsure, out);
    for (uint i = 0; i < VW; ++i) {
        if (out[i] != 0) out[i] = covers_exactly(&t, (float2)(x[i], ray_y)) ? -1 : 0;
    }
    return lane_load(out);
}

// The layer to draw, of LayerState of host/stages/surfaces/raster_layers.cpp. last_layer: the next
// farther one, unused if is_first. Both count in the planes.
#define LAYER_ARGS uint layer_rows, uint layer, uint last_layer, uint is_first

kernel void raster_layers(View view, SCENE_ARGS, TRIANGLE_LIST_ARGS(const),  // in any order
                          LAYER_ARGS,
                          global float* restrict keys,    // in, out [height][stride]: of the layer
                          global uint* restrict ids,      // in, out [][layer_rows][stride]:
                                                          // triangle + 1; 0: none
                          global uint* restrict drawn) {  // in, out [][2]: pixels that have a
                                                          // layer, and that may have more
    SurfaceScene scene = SCENE_OF_ARGS;
    ItemPlace at = place_in_planes(view);
    if (at.y >= layer_rows) return;
    Pixels pixels = row_pixels(view, at.x, at.y);
    global const uint* last_ids = ids + last_layer * layer_rows * view.stride;
    ids += layer * layer_rows * view.stride;
    drawn += 2u * layer;
    UV last_id = (UV)(0u);
    if (is_first == 0u) last_id = lane_load(last_ids + pixels.first);
    MASK open = (MASK)(0);
    if (at.inside) open = within_width(view, pixels);
    if (is_first == 0u) open &= lane_mask(last_id != (UV)(0u));
    if (!lane_any(open)) {
        lane_store((UV)(0u), ids + pixels.first);
        return;
    }
    FV last_key = lane_load(keys + pixels.first);
    FV near = far_key(view, pixels.x, pixels.y) + near_from_far(view);
    UV column = lane_numbers + at.x;
    FV x = ray_x(view, column);
    float y = ray_y(view, at.y);
    FV key = fv(INFINITY);
    UV id = (UV)(0u);
    MASK one = (MASK)(0), several = (MASK)(0);  // fragments in front, some of which
                                                // decide_exactly() may turn away
    uint tile = at.y / TILE_HEIGHT * raster_tiles_x(view) + at.x / TILE_WIDTH;
    uint end = min(offsets[tile + 1], capacity);
    for (uint i = offsets[tile]; i < end; ++i) {
        uint number = lists[i] & ~MASKED_TRIANGLE;
        global const RasterRow* t = triangles + number;
        if (at.y < interval_first(t->rows) || at.y > interval_last(t->rows)) continue;
        MASK wins = open & lane_mask(column >= (UV)(interval_first(t->columns))) &
                    lane_mask(column <= (UV)(interval_last(t->columns)));
        if (!lane_any(wins)) continue;
        FV least =
            min(along(t->edge, x, y), min(along(t->edge + 3, x, y), along(t->edge + 6, x, y)));
        FV k = min(max(along(t->plane, x, y), fv(t->farthest)), fv(t->nearest));
        UV k_id = (UV)(number + 1u);
        MASK in_front =
            lane_mask(k > last_key) | (lane_mask(k == last_key) & lane_mask(k_id < last_id));
        MASK behind_best = lane_mask(k < key) | (lane_mask(k == key) & lane_mask(k_id > id));
        wins &= in_front & lane_mask(k <= near) & lane_mask(least >= fv(-1.0f));
        several |= one & wins;
        one |= wins;
        wins &= behind_best;
        MASK unsure = wins & lane_mask(!(least > fv(1.0f)));
        if (lane_any(unsure)) {
            wins = (wins & ~unsure) | decide_exactly(scene, view, number, unsure, x, y);
        }
        key = lane_select(wins, k, key);
        id = select(id, k_id, wins);
    }
    MASK found = lane_mask(id != (UV)(0u));
    lane_store(lane_select(found, key, last_key), keys + pixels.first);
    lane_store(id, ids + pixels.first);
    if (lane_any(found)) atomic_add(drawn, popcount(lane_ballot(found)));
    if (lane_any(several)) atomic_add(drawn + 1, popcount(lane_ballot(several)));
}
