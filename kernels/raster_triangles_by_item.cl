// SPDX-License-Identifier: Apache-2.0
// Tiles' triangles -> the triangle that each pixel shows, by one work-item a tile, in lanes: VW
// triangles are set up at once, then each is drawn row by row, VW pixels at a time. For CPUs.
#include "kernels/device/raster_tile.h"
#include "kernels/device/raster_triangle.h"
#if HAS_MASKS
#include "kernels/device/alpha_mask.h"
#endif

// Strips begin where a triangle does: the last may end past the tile.
#define TILE_STRIDE (TILE_WIDTH + VW)

// Keys and ids so far, of the tile's pixels; and the rays' x of its columns.
typedef struct Tile {
    float key[TILE_HEIGHT * TILE_STRIDE];
    uint id[TILE_HEIGHT * TILE_STRIDE];
    float ray_x[TILE_STRIDE];
    uint x, y;           // of its first pixel, in the planes
    uint width, height;  // of its pixels in the picture
} Tile;

// RasterTriangles, triangle by triangle.
typedef struct Batch {
    float edge[9][VW];
    float plane[3][VW];
    float farthest[VW], nearest[VW];
    float sign[VW];
    int x0[VW], x1[VW], y0[VW], y1[VW];  // within the tile
    int masked[VW];
} Batch;

static inline void clear_tile(View view, Tile* tile) {
    for (uint x = 0; x < TILE_STRIDE; x += VW) {
        lane_store(ray_x(view, lane_numbers + (tile->x + x)), tile->ray_x + x);
    }
    for (uint y = 0; y < TILE_HEIGHT; ++y) {
        FV py = fv((float)(tile->y + y + view.first_row) + 0.5f);
        for (uint x = 0; x < TILE_STRIDE; x += VW) {
            FV px = lane_to_float(lane_numbers + (tile->x + x)) + 0.5f;
            lane_store(far_key(view, px, py), tile->key + y * TILE_STRIDE + x);
            lane_store((UV)(0u), tile->id + y * TILE_STRIDE + x);
        }
    }
}

static inline void store3(FV3 v, float (*to)[VW]) {
    lane_store(v.x, to[0]);
    lane_store(v.y, to[1]);
    lane_store(v.z, to[2]);
}

// Sets up the triangles of `numbers`, as many as are `wanted`.
static inline void fill_batch(SurfaceScene scene, View view, const Tile* tile, float2 span,
                              UV numbers, MASK wanted, Batch* out) {
    ViewTriangles t = view_triangles(scene, numbers, wanted);
    RasterTriangles r = set_up_triangles(view, span, t);
    PixelBounds b = pixel_bounds(view, t.v);
    for (uint i = 0; i < 3; ++i) store3(r.edge[i], out->edge + 3 * i);
    store3(r.plane, out->plane);
    lane_store(r.farthest, out->farthest);
    lane_store(r.nearest, out->nearest);
    lane_store(r.sign, out->sign);
    IV x = (IV)((int)tile->x);
    IV y = (IV)((int)tile->y);
    lane_store(max(b.x0 - x, (IV)(0)), out->x0);
    lane_store(min(b.x1 - x, (IV)((int)tile->width - 1)), out->x1);
    lane_store(max(b.y0 - y, (IV)(0)), out->y0);
    // No rows where nothing is covered.
    lane_store(select((IV)(-1), min(b.y1 - y, (IV)((int)tile->height - 1)), r.alive & wanted),
               out->y1);
    lane_store(t.masked, out->masked);
}

// A triangle on its way over the tile's rows.
typedef struct DrawnTriangle {
    uint number;  // along the instances
    float sign;
    FV edge_x[3], plane_x;  // of its affine functions; and what they are at the row's x = 0
    FV edge_row[3], plane_row;
    FV farthest, nearest;
} DrawnTriangle;

static inline void begin_row(const Batch* b, uint i, float ry, DrawnTriangle* t) {
    for (uint e = 0; e < 3; ++e) {
        t->edge_row[e] = fv(fma(b->edge[3 * e + 1][i], ry, -b->edge[3 * e + 2][i]));
    }
    t->plane_row = fv(fma(b->plane[1][i], ry, -b->plane[2][i]));
}

// Where floats cannot tell, integers do. Rare: inlined, it would keep its caller from that.
__attribute__((noinline)) static MASK decide_exactly(SurfaceScene scene, View view,
                                                     const DrawnTriangle* t, const float* rays_x,
                                                     float ry, MASK unsure) {
    Triangle triangle = fetch_triangle(scene, t->number + 1u);
    float3 seen[3];
    for (uint i = 0; i < 3; ++i) {
        seen[i] = view_vertex(triangle.instance, vload3(0, triangle.vertex[i]));
        if (view.orthographic != 0u) seen[i].z = -1.0f;
    }
    int inside[VW];
    lane_store(unsure, inside);
    for (uint i = 0; i < VW; ++i) {
        if (inside[i] != 0) {
            inside[i] = covers_exactly(seen, t->sign, (float2)(rays_x[i], ry)) ? -1 : 0;
        }
    }
    return lane_load(inside);
}

// The pixels of a strip that the triangle covers; past its box there are none.
static inline MASK covered(SurfaceScene scene, View view, const DrawnTriangle* t,
                           const float* rays_x, float ry) {
    FV rx = lane_load(rays_x);
    FV least = fma(t->edge_x[0], rx, t->edge_row[0]);
    least = min(least, fma(t->edge_x[1], rx, t->edge_row[1]));
    least = min(least, fma(t->edge_x[2], rx, t->edge_row[2]));
    MASK inside = lane_mask(least > fv(1.0f));
    MASK unsure = ~lane_mask(least < fv(-1.0f)) & ~inside;
    if (lane_any(unsure)) inside |= decide_exactly(scene, view, t, rays_x, ry, unsure);
    return inside;
}

static inline FV keys_of(const DrawnTriangle* t, const float* rays_x) {
    FV key = fma(t->plane_x, lane_load(rays_x), t->plane_row);
    return min(max(key, t->farthest), t->nearest);
}

static inline void store_strip(Tile* tile, uint place, MASK wins, FV key, uint number) {
    lane_store(lane_select(wins, key, lane_load(tile->key + place)), tile->key + place);
    lane_store(select(lane_load(tile->id + place), (UV)(number + 1u), wins), tile->id + place);
}

// Not nearer than the near plane.
static inline MASK behind_near(View view, const Tile* tile, FV key, uint x, uint y) {
    FV px = lane_to_float(lane_numbers + (tile->x + x)) + 0.5f;
    FV py = fv((float)(tile->y + y + view.first_row) + 0.5f);
    return lane_mask(key <= far_key(view, px, py) + near_from_far(view));
}

// Triangles that neither alpha nor the near plane cuts.
static inline void draw_whole(SurfaceScene scene, View view, Tile* tile, const Batch* b, uint i,
                              DrawnTriangle* t) {
    for (int y = b->y0[i]; y <= b->y1[i]; ++y) {
        float ry = ray_y(view, tile->y + (uint)y);
        begin_row(b, i, ry, t);
        for (int x = b->x0[i]; x <= b->x1[i]; x += VW) {
            uint place = (uint)y * TILE_STRIDE + (uint)x;
            FV key = keys_of(t, tile->ray_x + x);
            MASK wins = covered(scene, view, t, tile->ray_x + x, ry) &
                        lane_mask(key > lane_load(tile->key + place));
            store_strip(tile, place, wins, key, t->number);
        }
    }
}

// The pixels of a strip that a triangle wins whose turn comes in any order.
static inline MASK wins_cut(SurfaceScene scene, View view, const Tile* tile, const DrawnTriangle* t,
                            uint x, uint y, FV key) {
    uint place = y * TILE_STRIDE + x;
    FV old = lane_load(tile->key + place);
    // Background has the number 0 - 1, which is not smaller.
    MASK first =
        lane_mask(key == old) & lane_mask((UV)(t->number) < lane_load(tile->id + place) - 1u);
    return covered(scene, view, t, tile->ray_x + x, ray_y(view, tile->y + y)) &
           (lane_mask(key > old) | first) & behind_near(view, tile, key, x, y);
}

// Triangles that the near plane cuts.
static inline void draw_cut(SurfaceScene scene, View view, Tile* tile, const Batch* b, uint i,
                            DrawnTriangle* t) {
    for (int y = b->y0[i]; y <= b->y1[i]; ++y) {
        begin_row(b, i, ray_y(view, tile->y + (uint)y), t);
        for (int x = b->x0[i]; x <= b->x1[i]; x += VW) {
            FV key = keys_of(t, tile->ray_x + x);
            MASK wins = wins_cut(scene, view, tile, t, (uint)x, (uint)y, key);
            store_strip(tile, (uint)y * TILE_STRIDE + (uint)x, wins, key, t->number);
        }
    }
}

#if HAS_MASKS
// Pixels that a triangle wins if alpha leaves them: strips have few of them, samples are taken in
// full vectors.
#define MOST_FRAGMENTS (8 * VW)

typedef struct Fragments {
    float x[MOST_FRAGMENTS + VW], y[MOST_FRAGMENTS + VW];  // centres in the picture [pixel]
    float key[MOST_FRAGMENTS + VW];
    uint place[MOST_FRAGMENTS + VW];  // in the tile
    uint count;
} Fragments;

// Which lanes are set cannot be foreseen: each is written, and the next in its place if it is not.
static inline void add_fragments(const Tile* tile, View view, uint x, uint y, MASK wins, FV key,
                                 Fragments* f) {
    uint flag[VW];
    float keys[VW];
    lane_store(lane_bits(wins) & 1u, flag);
    lane_store(key, keys);
    float py = (float)(tile->y + y + view.first_row) + 0.5f;
    uint count = f->count;
#pragma unroll
    for (uint lane = 0; lane < VW; ++lane) {
        f->x[count] = (float)(tile->x + x + lane) + 0.5f;
        f->y[count] = py;
        f->key[count] = keys[lane];
        f->place[count] = y * TILE_STRIDE + x + lane;
        count += flag[lane];
    }
    f->count = count;
}

static inline void draw_fragments(SurfaceScene scene, View view, Tile* tile,
                                  const MaskedTriangle* t, uint number, Fragments* f) {
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
        lane_store(passes_mask(scene, view, t, pixels), left);
        for (uint i = 0; i < count; ++i) {
            if (left[i] == 0) continue;
            tile->key[f->place[first + i]] = f->key[first + i];
            tile->id[f->place[first + i]] = number + 1u;
        }
    }
    f->count = 0;
}

static inline void draw_masked(SurfaceScene scene, View view, Tile* tile, const Batch* b, uint i,
                               DrawnTriangle* t) {
    MaskedTriangle masked = fetch_masked_triangle(scene, view, t->number);
    Fragments fragments;
    fragments.count = 0;
    for (int y = b->y0[i]; y <= b->y1[i]; ++y) {
        begin_row(b, i, ray_y(view, tile->y + (uint)y), t);
        for (int x = b->x0[i]; x <= b->x1[i]; x += VW) {
            FV key = keys_of(t, tile->ray_x + x);
            MASK wins = wins_cut(scene, view, tile, t, (uint)x, (uint)y, key);
            if (!lane_any(wins)) continue;
            add_fragments(tile, view, (uint)x, (uint)y, wins, key, &fragments);
            if (fragments.count < MOST_FRAGMENTS) continue;
            draw_fragments(scene, view, tile, &masked, t->number, &fragments);
        }
    }
    draw_fragments(scene, view, tile, &masked, t->number, &fragments);
}
#endif

// One triangle of a batch. `sure_key`: no pixel's near plane has a smaller one.
static inline void draw_triangle(SurfaceScene scene, View view, float sure_key, Tile* tile,
                                 const Batch* b, uint i, uint number) {
    DrawnTriangle t;
    t.number = number;
    t.sign = b->sign[i];
    for (uint e = 0; e < 3; ++e) t.edge_x[e] = fv(b->edge[3 * e][i]);
    t.plane_x = fv(b->plane[0][i]);
    t.farthest = fv(b->farthest[i]);
    t.nearest = fv(b->nearest[i]);
#if HAS_MASKS
    if (b->masked[i] != 0) {
        draw_masked(scene, view, tile, b, i, &t);
        return;
    }
#endif
    if (b->nearest[i] < sure_key) {
        draw_whole(scene, view, tile, b, i, &t);
    } else {
        draw_cut(scene, view, tile, b, i, &t);
    }
}

static inline void store_tile(View view, const Tile* tile, global uint* ids) {
    uint end = min(tile->x + TILE_WIDTH, view.stride) - tile->x;
    for (uint y = 0; y < tile->height; ++y) {
        global uint* row = ids + (size_t)(tile->y + y) * view.stride + tile->x;
        for (uint x = 0; x < end; x += VW) {
            lane_store(lane_load(tile->id + y * TILE_STRIDE + x), row + x);
        }
    }
}

// Draws triangles of one tile, in their order. With `put_off` not null, those that alpha cuts are
// appended to it instead, of which there are `put_off_count`, and room for VW more.
static inline void draw_list(SurfaceScene scene, View view, Tile* tile, const uint* numbers,
                             uint count, uint* put_off, uint* put_off_count) {
    Batch batch;
    fill_batch(scene, view, tile, ray_span(view), lane_load(numbers),
               lane_mask(lane_numbers < (UV)(count)), &batch);
    float sure_key = least_near_key(view);
    for (uint i = 0; i < count; ++i) {
        if (put_off && batch.masked[i] != 0) {
            put_off[(*put_off_count)++] = numbers[i];
        } else {
            draw_triangle(scene, view, sure_key, tile, &batch, i, numbers[i]);
        }
    }
}

#if HAS_MASKS
// Triangles that alpha cuts come after the others, which may hide them: samples cost most.
#define MOST_PUT_OFF (64 * VW)

static inline void draw_put_off(SurfaceScene scene, View view, Tile* tile, const uint* put_off,
                                uint count) {
    for (uint first = 0; first < count; first += VW) {
        draw_list(scene, view, tile, put_off + first, min(count - first, (uint)VW), 0, 0);
    }
}
#endif

kernel void raster_triangles(
    View view,
    global const InstanceRow* restrict instances,  // ascending first_triangle, and an end
    global const uint* restrict instance_blocks,   // by INSTANCE_BLOCK triangles
    global const MeshRow* restrict meshes, global const float* restrict vertices,
    global const uint* restrict indices, global const SurfaceMaterial* restrict materials,
    global const TextureRow* restrict textures, global const ulong* restrict texels,
    global const uint* restrict offsets,  // [tiles + 1]
    global const uint* restrict lists,    // [capacity]: triangles of each tile, ascending
    uint capacity,
    global uint* restrict ids) {  // out [height][stride]: triangle + 1; 0 for background
    SurfaceScene scene = {instances, instance_blocks, meshes,   vertices,
                          indices,   materials,       textures, texels};
    uint tiles_x = raster_tiles_x(view);
    uint number = get_global_id(0);
    Tile tile;
    tile.x = number % tiles_x * TILE_WIDTH;
    tile.y = number / tiles_x * TILE_HEIGHT;
    tile.width = min(view.width - tile.x, (uint)TILE_WIDTH);
    tile.height = min(view.height - tile.y, (uint)TILE_HEIGHT);
    clear_tile(view, &tile);
    uint end = min(offsets[number + 1], capacity);
#if HAS_MASKS
    uint put_off[MOST_PUT_OFF + 2 * VW];
    uint put_off_count = 0;
#endif
    for (uint first = offsets[number]; first < end; first += VW) {
        uint triangles[VW];
        for (uint i = 0; i < VW; ++i) triangles[i] = lists[min(first + i, end - 1u)];
        uint count = min(end - first, (uint)VW);
#if HAS_MASKS
        draw_list(scene, view, &tile, triangles, count, put_off, &put_off_count);
        if (put_off_count < MOST_PUT_OFF) continue;
        draw_put_off(scene, view, &tile, put_off, put_off_count);
        put_off_count = 0;
#else
        draw_list(scene, view, &tile, triangles, count, 0, 0);
#endif
    }
#if HAS_MASKS
    draw_put_off(scene, view, &tile, put_off, put_off_count);
#endif
    store_tile(view, &tile, ids);
}
