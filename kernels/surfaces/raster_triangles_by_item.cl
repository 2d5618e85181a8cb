// SPDX-License-Identifier: Apache-2.0
// Tiles' triangles -> the triangle that each pixel shows, by one work-item a tile, triangle by
// triangle, VW pixels at a time. For CPUs.
#include "kernels/device/arguments.h"
#include "kernels/device/prefetch.h"
#include "kernels/surfaces/tile_strips.h"
#if HAS_MASKS
#include "kernels/surfaces/tile_fragments.h"
#endif

// Prefetches triangles' rows so many triangles ahead.
#define ROWS_AHEAD 8

// Draws triangles without alpha mask. `is_cut`, by the near plane, is a constant of each call: it
// chooses a loop.
static inline void draw_opaque(Canvas c, global const RasterRow* t, uint number, bool is_cut) {
    StripEdges edges = edges_of(t);
    StripBox box = strip_box(c.tile, t);
    StripSpans spans;
    find_spans(*c.view, c.tile, t, box, &spans);
    Strip s;
    for (s.y = box.y0; s.y <= box.y1; ++s.y) {
        begin_strips(c.tile, s.y, t, &edges);
        int last = spans.last[s.y];
        for (int x = spans.first[s.y]; x <= last; x += STRIP_COLUMNS) {
            s.x = (uint)x;
            FV key = keys_of(c.tile, &edges, s);
            MASK wins = is_cut ? wins_cut(c, number, &edges, s, key)
                               : wins_whole(c, number, &edges, s, key);
            store_strip(c.tile, s, wins, key, number);
        }
    }
}

kernel void raster_triangles(
    View view, SCENE_ARGS, TRIANGLE_LIST_ARGS(const),  // ascending
    global uint* restrict ids) {  // out [height][stride]: triangle + 1; 0 for background
    SurfaceScene scene = SCENE_OF_ARGS;
    uint tiles_x = raster_tiles_x(view);
    uint tile_number = get_global_id(0);
    Tile tile;
    tile.x = tile_number % tiles_x * TILE_WIDTH;
    tile.y = tile_number / tiles_x * TILE_HEIGHT;
    tile.width = min(view.width - tile.x, (uint)TILE_WIDTH);
    tile.height = min(view.height - tile.y, (uint)TILE_HEIGHT);
    clear_tile(view, &tile);
    Canvas canvas = {&scene, &view, &tile};
    float sure_key = least_near_key(view);
    uint end = min(offsets[tile_number + 1], capacity);
#if HAS_MASKS
    uint put_off[MOST_PUT_OFF];
    uint put_off_count = 0;
#endif
    for (uint i = offsets[tile_number]; i < end; ++i) {
        prefetch_to_read(triangles + (lists[min(i + ROWS_AHEAD, end - 1u)] & ~MASKED_TRIANGLE));
        uint number = lists[i] & ~MASKED_TRIANGLE;
#if HAS_MASKS
        if (lists[i] != number) {
            put_off[put_off_count++] = number;
            if (put_off_count == MOST_PUT_OFF) {
                draw_put_off(canvas, triangles, put_off, put_off_count);
                put_off_count = 0;
            }
            continue;
        }
#endif
        global const RasterRow* t = triangles + number;
        if (t->nearest < sure_key) {
            draw_opaque(canvas, t, number, false);
        } else {
            draw_opaque(canvas, t, number, true);
        }
    }
#if HAS_MASKS
    draw_put_off(canvas, triangles, put_off, put_off_count);
#endif
    store_tile(view, &tile, ids);
}
