// SPDX-License-Identifier: Apache-2.0
// Draws triangles with alpha masks into a tile's strips: gathers the pixels that each would win, so
// that textures are sampled in full vectors.
#ifndef KILOLUX_DEVICE_TILE_FRAGMENTS_H
#define KILOLUX_DEVICE_TILE_FRAGMENTS_H
#include "kernels/surfaces/alpha_mask.h"
#include "kernels/surfaces/tile_strips.h"

// Most pixels that a triangle would win: strips have few of them, so samples are taken in full
// vectors.
#define MOST_FRAGMENTS (8 * VW)

typedef struct Fragments {
    float x[MOST_FRAGMENTS + VW], y[MOST_FRAGMENTS + VW];  // centres in the picture [pixel]
    float key[MOST_FRAGMENTS + VW];
    uint place[MOST_FRAGMENTS + VW];  // in the tile
    uint count;
} Fragments;

// A branch could not be predicted, so each lane is written, and the next one overwrites it if it is
// not set.
static inline void add_fragments(Canvas c, Strip s, MASK wins, FV key, Fragments* f) {
    uint flag[VW];
    float keys[VW], x[VW], y[VW];
    lane_store(lane_bits(wins) & 1u, flag);
    lane_store(key, keys);
    lane_store(centres_x(*c.view, c.tile, s), x);
    lane_store(centres_y(*c.view, c.tile, s), y);
    uint count = f->count;
#pragma unroll
    for (uint lane = 0; lane < VW; ++lane) {
        f->x[count] = x[lane];
        f->y[count] = y[lane];
        f->key[count] = keys[lane];
        f->place[count] = place_of(s) + lane;
        count += flag[lane];
    }
    f->count = count;
}

static inline void draw_fragments(Canvas c, const MaskedTriangle* t, uint number, Fragments* f) {
    for (uint first = 0; first < f->count; first += VW) {
        uint count = min(f->count - first, (uint)VW);
        for (uint i = count; i < VW; ++i) {
            f->x[first + i] = f->x[first];
            f->y[first + i] = f->y[first];
        }
        Pixels pixels;
        pixels.x = lane_load(f->x + first);
        pixels.y = lane_load(f->y + first);
        pixels.first = 0;
        int left[VW];
        lane_store(passes_mask(*c.scene, *c.view, t, pixels), left);
        for (uint i = 0; i < count; ++i) {
            if (left[i] == 0) continue;
            c.tile->key[f->place[first + i]] = f->key[first + i];
            c.tile->id[f->place[first + i]] = number + 1u;
        }
    }
    f->count = 0;
}

static inline void draw_masked(Canvas c, global const RasterRow* t, uint number) {
    MaskedTriangle masked = fetch_masked_triangle(*c.scene, *c.view, number);
    Fragments fragments;
    fragments.count = 0;
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
            MASK wins = wins_cut(c, number, &edges, s, key);
            if (!lane_any(wins)) continue;
            add_fragments(c, s, wins, key, &fragments);
            if (fragments.count >= MOST_FRAGMENTS) draw_fragments(c, &masked, number, &fragments);
        }
    }
    draw_fragments(c, &masked, number, &fragments);
}

// Triangles with alpha masks come after the others, which may hide them: samples cost most.
#define MOST_PUT_OFF (64 * VW)

static inline void draw_put_off(Canvas c, global const RasterRow* triangles, const uint* put_off,
                                uint count) {
    for (uint i = 0; i < count; ++i) draw_masked(c, triangles + put_off[i], put_off[i]);
}

#endif
