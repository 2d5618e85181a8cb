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

// Where floats cannot tell, integers do.
static inline MASK decide_exactly(SurfaceScene scene, View view, uint number, float sign,
                                  const float* rays_x, float ry, MASK unsure) {
    Triangle t = fetch_triangle(scene, number + 1u);
    float3 seen[3];
    for (uint i = 0; i < 3; ++i) {
        seen[i] = view_vertex(t.instance, vload3(0, t.vertex[i]));
        if (view.orthographic != 0u) seen[i].z = -1.0f;
    }
    int inside[VW];
    lane_store(unsure, inside);
    for (uint i = 0; i < VW; ++i) {
        if (inside[i] != 0) {
            inside[i] = covers_exactly(seen, sign, (float2)(rays_x[i], ry)) ? -1 : 0;
        }
    }
    return lane_load(inside);
}

// One triangle of a batch.
static inline void draw_triangle(SurfaceScene scene, View view, Tile* tile, const Batch* b, uint i,
                                 uint number) {
#if HAS_MASKS
    MaskedTriangle mask_triangle;
    if (b->masked[i] != 0) mask_triangle = fetch_masked_triangle(scene, number);
#endif
    float nearer = near_from_far(view);
    for (int y = b->y0[i]; y <= b->y1[i]; ++y) {
        float ry = ray_y(view, tile->y + (uint)y);
        float row[4];
        for (uint e = 0; e < 3; ++e) row[e] = fma(b->edge[3 * e + 1][i], ry, -b->edge[3 * e + 2][i]);
        row[3] = fma(b->plane[1][i], ry, -b->plane[2][i]);
        for (int x = b->x0[i]; x <= b->x1[i]; x += VW) {
            FV rx = lane_load(tile->ray_x + x);
            FV u0 = fma(fv(b->edge[0][i]), rx, fv(row[0]));
            FV u1 = fma(fv(b->edge[3][i]), rx, fv(row[1]));
            FV u2 = fma(fv(b->edge[6][i]), rx, fv(row[2]));
            FV least = min(u0, min(u1, u2));
            MASK within = lane_mask(lane_numbers <= (UV)((uint)(b->x1[i] - x)));
            MASK possible = ~lane_mask(least < fv(-1.0f)) & within;
            if (!lane_any(possible)) continue;
            MASK inside = lane_mask(least > fv(1.0f)) & within;
            MASK unsure = possible & ~inside;
            if (lane_any(unsure)) {
                inside |= decide_exactly(scene, view, number, b->sign[i], tile->ray_x + x, ry,
                                         unsure);
            }
            FV key = fma(fv(b->plane[0][i]), rx, fv(row[3]));
            key = min(max(key, fv(b->farthest[i])), fv(b->nearest[i]));
            uint place = (uint)y * TILE_STRIDE + (uint)x;
            FV old = lane_load(tile->key + place);
            MASK wins = inside & lane_mask(key > old);
            FV px = lane_to_float(lane_numbers + (tile->x + (uint)x)) + 0.5f;
            FV py = fv((float)(tile->y + (uint)y + view.first_row) + 0.5f);
            wins &= lane_mask(key <= far_key(view, px, py) + nearer);
            if (!lane_any(wins)) continue;
#if HAS_MASKS
            if (b->masked[i] != 0) {
                Pixels pixels = row_pixels(view, tile->x + (uint)x, tile->y + (uint)y);
                wins &= passes_mask(scene, view, &mask_triangle, pixels);
            }
#endif
            lane_store(lane_select(wins, key, old), tile->key + place);
            lane_store(select(lane_load(tile->id + place), (UV)(number + 1u), wins),
                       tile->id + place);
        }
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

kernel void raster_triangles(
    View view,
    global const InstanceRow* restrict instances,  // [instance_count], ascending first_triangle
    uint instance_count,                           // at least 1
    global const MeshRow* restrict meshes, global const float* restrict vertices,
    global const uint* restrict indices, global const SurfaceMaterial* restrict materials,
    global const TextureRow* restrict textures, global const ulong* restrict texels,
    global const uint* restrict offsets,  // [tiles + 1]
    global const uint* restrict lists,    // [capacity]: triangles of each tile, ascending
    uint capacity,
    global uint* restrict ids) {  // out [height][stride]: triangle + 1; 0 for background
    SurfaceScene scene = {instances, instance_count, meshes,   vertices,
                          indices,   materials,      textures, texels};
    uint tiles_x = raster_tiles_x(view);
    uint number = get_global_id(0);
    Tile tile;
    tile.x = number % tiles_x * TILE_WIDTH;
    tile.y = number / tiles_x * TILE_HEIGHT;
    tile.width = min(view.width - tile.x, (uint)TILE_WIDTH);
    tile.height = min(view.height - tile.y, (uint)TILE_HEIGHT);
    clear_tile(view, &tile);
    float2 span = ray_span(view);
    uint end = min(offsets[number + 1], capacity);
    for (uint first = offsets[number]; first < end; first += VW) {
        uint triangles[VW];
        for (uint i = 0; i < VW; ++i) triangles[i] = lists[min(first + i, end - 1u)];
        Batch batch;
        fill_batch(scene, view, &tile, span, lane_load(triangles),
                   lane_mask(lane_numbers < (UV)(end - first)), &batch);
        for (uint i = 0; i < VW; ++i) draw_triangle(scene, view, &tile, &batch, i, triangles[i]);
    }
    store_tile(view, &tile, ids);
}
