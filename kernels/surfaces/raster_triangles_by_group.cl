// SPDX-License-Identifier: Apache-2.0
// Tiles' triangles -> the triangle that each pixel shows, by a work-group a tile: each item fetches
// a triangle, then all items test their pixels against all of them. For GPUs, with one lane.
//
// A batch is drawn in two passes. The first draws where floats are certain; it calls no functions,
// so it needs few registers. The second takes the triangles that alpha cuts, or whose edge passes a
// pixel too closely. The order does not matter: the nearest fragment wins, and of equally near ones
// the first triangle's.
#ifndef GROUP
#define GROUP 256
#endif
#include "kernels/device/arguments.h"
#include "kernels/surfaces/raster_tile.h"
#include "kernels/surfaces/raster_triangle.h"
#if HAS_MASKS
#include "kernels/surfaces/alpha_mask.h"
#endif

// 32 neighbouring items draw a region of the tile together, in rounds of neighbouring pixels. Each
// region has its own list of the batch's triangles, since most touch few regions.
#define REGION_ITEMS 32
#define REGIONS (GROUP / REGION_ITEMS)
#define REGION_PIXELS (TILE_WIDTH * TILE_HEIGHT / REGIONS)
#define ROUNDS (REGION_PIXELS / REGION_ITEMS)
#if REGION_PIXELS >= 512 && TILE_WIDTH >= 32
#define REGION_WIDTH 32
#elif REGION_PIXELS >= 128
#define REGION_WIDTH 16
#else
#define REGION_WIDTH 8
#endif
#define REGION_HEIGHT (REGION_PIXELS / REGION_WIDTH)
#define REGIONS_ACROSS (TILE_WIDTH / REGION_WIDTH)
#define BLOCK_WIDTH 8
#define BLOCK_HEIGHT (REGION_ITEMS / BLOCK_WIDTH)

// A triangle in the items' shared memory.
typedef struct SharedTriangle {
    float3 edge[3];
    float3 plane;
    float farthest, nearest;
    uint columns, rows;  // intervals of pixels of the tile; none: EMPTY_INTERVAL
    uint number;         // with MASKED_TRIANGLE
} SharedTriangle;

// The present state of a pixel.
typedef struct RasterPixel {
    uint x, y;            // in the planes
    uint tile_x, tile_y;  // in the tile
    float ray_x, ray_y;
    float key, nearest;  // so far; at the near plane
    uint id;
} RasterPixel;

static inline RasterPixel first_pixel(View view, uint tile_x, uint tile_y, uint round) {
    uint region = (uint)get_local_id(0) / REGION_ITEMS;
    uint item = (uint)get_local_id(0) % REGION_ITEMS;
    uint blocks_across = REGION_WIDTH / BLOCK_WIDTH;
    RasterPixel p;
    p.tile_x = region % REGIONS_ACROSS * REGION_WIDTH + round % blocks_across * BLOCK_WIDTH +
               item % BLOCK_WIDTH;
    p.tile_y = region / REGIONS_ACROSS * REGION_HEIGHT + round / blocks_across * BLOCK_HEIGHT +
               item / BLOCK_WIDTH;
    p.x = tile_x + p.tile_x;
    p.y = tile_y + p.tile_y;
    p.ray_x = ray_x(view, p.x);
    p.ray_y = ray_y(view, p.y);
    p.key = far_key(view, (float)(p.x + view.first_column) + 0.5f,
                    (float)(p.y + view.first_row) + 0.5f);
    p.nearest = p.key + near_from_far(view);
    p.id = 0u;
    return p;
}

// The part of an interval that lies in a tile's `size` pixels from `start` on.
static inline uint interval_in_tile(uint interval, uint start, uint size) {
    uint first = max(interval_first(interval), start) - start;
    uint last = min(interval_last(interval), start + size - 1u);
    return last < start + first ? EMPTY_INTERVAL : interval_of(first, last - start);
}

static inline SharedTriangle shared_triangle(global const RasterRow* row, uint number, uint tile_x,
                                             uint tile_y) {
    RasterRow t = *row;
    SharedTriangle out;
    for (uint i = 0; i < 3; ++i) {
        out.edge[i] = (float3)(t.edge[3 * i], t.edge[3 * i + 1], t.edge[3 * i + 2]);
    }
    out.plane = (float3)(t.plane[0], t.plane[1], t.plane[2]);
    out.farthest = t.farthest;
    out.nearest = t.nearest;
    out.columns = interval_in_tile(t.columns, tile_x, TILE_WIDTH);
    out.rows = interval_in_tile(t.rows, tile_y, TILE_HEIGHT);
    out.number = number;
    return out;
}

static inline bool overlaps(uint interval, uint first, uint size) {
    return interval_first(interval) < first + size && interval_last(interval) >= first;
}

// A region's triangles of a batch, by the items that fetched them.
typedef struct RegionList {
    uchar first[GROUP];        // of the first pass
    uint count;                // of them
    uint second[GROUP / 32u];  // bits: of the second pass
} RegionList;

static inline void clear_list(local RegionList* list) {
    list->count = 0u;
    for (uint i = 0; i < GROUP / 32u; ++i) list->second[i] = 0u;
}

static inline uint lowest_bit(uint bits) { return 31u - clz(bits & -bits); }

static inline void take_second(local RegionList* list, uint item) {
    atomic_or(list->second + item / 32u, 1u << item % 32u);
}

// Puts the item's triangle into the lists of the regions that its box touches.
static inline void list_in_regions(const SharedTriangle* t, uint item, local RegionList* lists) {
    for (uint region = 0; region < REGIONS; ++region) {
        if (!overlaps(t->columns, region % REGIONS_ACROSS * REGION_WIDTH, REGION_WIDTH)) continue;
        if (!overlaps(t->rows, region / REGIONS_ACROSS * REGION_HEIGHT, REGION_HEIGHT)) continue;
        local RegionList* list = lists + region;
        if (HAS_MASKS && (t->number & MASKED_TRIANGLE) != 0u) {
            take_second(list, item);
        } else {
            list->first[atomic_inc(&list->count)] = (uchar)item;
        }
    }
}

static inline bool within(uint interval, uint i) {
    return i >= interval_first(interval) && i <= interval_last(interval);
}

// Integers decide where floats are uncertain. It is rare: inlined, it would cost the rest
// registers.
__attribute__((noinline)) static bool decide_exactly(SurfaceScene scene, View view, uint number,
                                                     float2 ray) {
    ExactTriangle t = exact_triangle(scene, view, number);
    return covers_exactly(&t, ray);
}

#if HAS_MASKS
__attribute__((noinline)) static bool shows_texel(SurfaceScene scene, View view, uint number,
                                                  uint x, uint y) {
    MaskedTriangle masked = fetch_masked_triangle(scene, view, number);
    return passes_mask(scene, view, &masked, row_pixels(view, x, y)) != 0;
}
#endif

static inline float along(float3 e, float x, float y) { return fma(e.x, x, fma(e.y, y, -e.z)); }

// A triangle at a pixel.
typedef struct RasterFragment {
    float key;
    bool wins;  // if it is covered
    bool sure;  // that it is covered
} RasterFragment;

static inline RasterFragment fragment_at(local const SharedTriangle* t, uint number,
                                         const RasterPixel* p) {
    RasterFragment out = {0.0f, false, false};
    if (!within(t->columns, p->tile_x) || !within(t->rows, p->tile_y)) return out;
    float least =
        min(along(t->edge[0], p->ray_x, p->ray_y),
            min(along(t->edge[1], p->ray_x, p->ray_y), along(t->edge[2], p->ray_x, p->ray_y)));
    if (least < -1.0f) return out;
    out.sure = least > 1.0f;
    out.key = min(max(along(t->plane, p->ray_x, p->ray_y), t->farthest), t->nearest);
    bool nearer = out.key > p->key || (out.key == p->key && p->id != 0u && number + 1u < p->id);
    out.wins = nearer && out.key <= p->nearest;
    return out;
}

// The first pass. True where floats are uncertain.
static inline bool draw_sure(local const SharedTriangle* t, RasterPixel* p) {
    RasterFragment f = fragment_at(t, t->number, p);
    if (f.wins && f.sure) {
        p->key = f.key;
        p->id = t->number + 1u;
    }
    return f.wins && !f.sure;
}

// The second pass.
static inline void draw_asking(SurfaceScene scene, View view, local const SharedTriangle* t,
                               RasterPixel* p) {
    uint number = t->number & ~MASKED_TRIANGLE;
    RasterFragment f = fragment_at(t, number, p);
    if (!f.wins) return;
    if (!f.sure && !decide_exactly(scene, view, number, (float2)(p->ray_x, p->ray_y))) return;
#if HAS_MASKS
    if (t->number != number && !shows_texel(scene, view, number, p->x, p->y)) return;
#endif
    p->key = f.key;
    p->id = number + 1u;
}

kernel void raster_triangles(
    View view, SCENE_ARGS, TRIANGLE_LIST_ARGS(const),  // in any order
    global uint* restrict ids) {  // out [height][stride]: triangle + 1; 0 for background
    local SharedTriangle batch[GROUP];
    local RegionList region_lists[REGIONS];
    SurfaceScene scene = SCENE_OF_ARGS;
    uint tiles_x = raster_tiles_x(view);
    uint tile = get_group_id(0);
    uint tile_x = tile % tiles_x * TILE_WIDTH;
    uint tile_y = tile / tiles_x * TILE_HEIGHT;
    RasterPixel pixels[ROUNDS];
#pragma unroll
    for (uint i = 0; i < ROUNDS; ++i) pixels[i] = first_pixel(view, tile_x, tile_y, i);
    uint item = get_local_id(0);
    local RegionList* list = region_lists + item / REGION_ITEMS;
    uint end = min(offsets[tile + 1], capacity);
    for (uint first = offsets[tile]; first < end; first += GROUP) {
        uint mine = first + item;
        if (item < REGIONS) clear_list(region_lists + item);
        barrier(CLK_LOCAL_MEM_FENCE);  // empty before any item adds to it
        if (mine < end) {
            uint number = lists[mine];
            SharedTriangle t =
                shared_triangle(triangles + (number & ~MASKED_TRIANGLE), number, tile_x, tile_y);
            batch[item] = t;
            list_in_regions(&t, item, region_lists);
        }
        barrier(CLK_LOCAL_MEM_FENCE);  // all are there
        for (uint j = 0; j < list->count; ++j) {
            bool ask = false;
#pragma unroll
            for (uint i = 0; i < ROUNDS; ++i) ask |= draw_sure(batch + list->first[j], pixels + i);
            if (ask) take_second(list, list->first[j]);
        }
        barrier(CLK_LOCAL_MEM_FENCE);  // the second pass knows its triangles
        for (uint word = 0; word < GROUP / 32u; ++word) {
            for (uint left = list->second[word]; left != 0u; left &= left - 1u) {
                local const SharedTriangle* t = batch + 32u * word + lowest_bit(left);
#pragma unroll
                for (uint i = 0; i < ROUNDS; ++i) draw_asking(scene, view, t, pixels + i);
            }
        }
        barrier(CLK_LOCAL_MEM_FENCE);  // all are drawn before the next come
    }
#pragma unroll
    for (uint i = 0; i < ROUNDS; ++i) {
        RasterPixel p = pixels[i];
        if (p.x < view.width && p.y < view.height) ids[(size_t)p.y * view.stride + p.x] = p.id;
    }
}
