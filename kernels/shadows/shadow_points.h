// SPDX-License-Identifier: Apache-2.0
// The points at which visibility is asked, in rows of VW, and the state of their rays to one light.
#ifndef KILOLUX_DEVICE_SHADOW_POINTS_H
#define KILOLUX_DEVICE_SHADOW_POINTS_H
#include "kernels/device/lit_item.h"
#include "kernels/device/longest_edge.h"
#include "kernels/shadows/shadow_space.h"

// Whether walks count nodes, triangles and rays in ShadowPoints: for measurements.
#ifndef COUNT_SHADOWS
#define COUNT_SHADOWS 0
#endif
#if COUNT_SHADOWS
#define ADD_COUNT(points, name, number) (points)->counts.name += (ulong)(number)
#else
#define ADD_COUNT(points, name, number)
#endif

// Whether walks may sum what surfaces let through, at one row of points.
#ifndef TINTED_SHADOWS
#define TINTED_SHADOWS 0
#endif
#if TINTED_SHADOWS
#include "kernels/shadows/shadow_tint.h"
#endif

// Points in rows of VW.
typedef struct ShadowPoints {
    float x[SHADOW_POINTS], y[SHADOW_POINTS], z[SHADOW_POINTS];  // [m]
    float nx[SHADOW_POINTS], ny[SHADOW_POINTS], nz[SHADOW_POINTS];
    // The points in the coordinates of edges' forms, see ShadowForm; or, of a light with a size,
    // their targets [m].
    float ex[SHADOW_POINTS], ey[SHADOW_POINTS], ez[SHADOW_POINTS];
    float lit[SHADOW_POINTS];        // masks in the bits of floats
    uchar rows[SHADOW_POINTS / VW];  // those with lit points
    uint row_count;
#if AREA_SHADOWS
    float px[SHADOW_POINTS], py[SHADOW_POINTS], pz[SHADOW_POINTS];  // AreaOrigins
    float qx[SHADOW_POINTS], qy[SHADOW_POINTS], qz[SHADOW_POINTS];
    float key[SHADOW_POINTS];  // in the bits of floats
#if AREA_LOBES > 1u
    float gloss[6][SHADOW_POINTS];
#endif
#endif
#if TINTED_SHADOWS
    TintSums tints;  // of row 0
#endif
#if COUNT_SHADOWS
    ShadowCounts counts;
#endif
} ShadowPoints;

static inline void reset_counts(ShadowPoints* points) {
#if COUNT_SHADOWS
    points->counts = (ShadowCounts){0, 0, 0, 0, 0, 0, 0, 0};
#endif
}

// Adds the counts of other points.
static inline void add_counts(ShadowPoints* to, const ShadowPoints* from) {
#if COUNT_SHADOWS
    to->counts.shafts += from->counts.shafts;
    to->counts.rays += from->counts.rays;
    to->counts.met_rays += from->counts.met_rays;
    to->counts.seen += from->counts.seen;
    to->counts.nodes += from->counts.nodes;
    to->counts.triangles += from->counts.triangles;
    to->counts.points += from->counts.points;
#endif
}

static inline uint lane_count(MASK mask) { return popcount(lane_ballot(mask)); }

static inline void store_point(ShadowPoints* to, uint row, FV3 p, FV3 n) {
    uint at = row * VW;
    lane_store(p.x, to->x + at);
    lane_store(p.y, to->y + at);
    lane_store(p.z, to->z + at);
    lane_store(n.x, to->nx + at);
    lane_store(n.y, to->ny + at);
    lane_store(n.z, to->nz + at);
}

static inline void load_origins(ShadowPoints* to, uint row, global const float* origins, uint plane,
                                Pixels pixels) {
    FV3 p = fv3(LOAD_PLANE(FV, origins + ORIGIN_X * plane, pixels),
                LOAD_PLANE(FV, origins + ORIGIN_Y * plane, pixels),
                LOAD_PLANE(FV, origins + ORIGIN_Z * plane, pixels));
    store_point(to, row, p,
                unpacked_normal(LOAD_PLANE(FV, origins + ORIGIN_NORMAL * plane, pixels)));
}

// Point `i` as that of another place.
static inline void copy_point(ShadowPoints* to, uint at, const ShadowPoints* from, uint i) {
    to->x[at] = from->x[i], to->y[at] = from->y[i], to->z[at] = from->z[i];
    to->nx[at] = from->nx[i], to->ny[at] = from->ny[i], to->nz[at] = from->nz[i];
#if AREA_SHADOWS
    to->px[at] = from->px[i], to->py[at] = from->py[i], to->pz[at] = from->pz[i];
    to->qx[at] = from->qx[i], to->qy[at] = from->qy[i], to->qz[at] = from->qz[i];
    to->key[at] = from->key[i];
#if AREA_LOBES > 1u
    for (uint k = 0; k < 6u; ++k) to->gloss[k][at] = from->gloss[k][i];
#endif
#endif
}

static inline FV3 load_points(const ShadowPoints* points, uint row) {
    uint at = row * VW;
    return fv3(lane_load(points->x + at), lane_load(points->y + at), lane_load(points->z + at));
}

#if AREA_SHADOWS
static inline void store_area_origins(ShadowPoints* to, uint row, AreaOrigins from) {
    uint at = row * VW;
    lane_store(from.position.x, to->px + at);
    lane_store(from.position.y, to->py + at);
    lane_store(from.position.z, to->pz + at);
    lane_store(from.normal.x, to->qx + at);
    lane_store(from.normal.y, to->qy + at);
    lane_store(from.normal.z, to->qz + at);
    lane_store(lane_from_bits(from.key), to->key + at);
#if AREA_LOBES > 1u
    lane_store(from.gloss_x.x, to->gloss[0] + at);
    lane_store(from.gloss_x.y, to->gloss[1] + at);
    lane_store(from.gloss_x.z, to->gloss[2] + at);
    lane_store(from.gloss_y.x, to->gloss[3] + at);
    lane_store(from.gloss_y.y, to->gloss[4] + at);
    lane_store(from.gloss_y.z, to->gloss[5] + at);
#endif
}

static inline AreaOrigins load_area_origins(const ShadowPoints* from, uint row) {
    uint at = row * VW;
    AreaOrigins out;
    out.position =
        fv3(lane_load(from->px + at), lane_load(from->py + at), lane_load(from->pz + at));
    out.normal = fv3(lane_load(from->qx + at), lane_load(from->qy + at), lane_load(from->qz + at));
    out.key = lane_bits(lane_load(from->key + at));
#if AREA_LOBES > 1u
    out.gloss_x = fv3(lane_load(from->gloss[0] + at), lane_load(from->gloss[1] + at),
                      lane_load(from->gloss[2] + at));
    out.gloss_y = fv3(lane_load(from->gloss[3] + at), lane_load(from->gloss[4] + at),
                      lane_load(from->gloss[5] + at));
#endif
    return out;
}
#endif

// What rays to lights with a size need of a row's pixels.
static inline void load_area_pixels(ShadowPoints* to, uint row, GBuffer g, Pixels pixels) {
#if AREA_SHADOWS
    Surface s = load_surface(g, pixels, lit_item(g, pixels).z);
    AreaOrigins from = area_origins(make_shading_point(s, g.view.orthographic != 0u), pixels);
    store_area_origins(to, row, from);
#endif
}

// A box that grows.
typedef struct LaneBox {
    FV3 low, high;
} LaneBox;

static inline LaneBox no_box(void) {
    return (LaneBox){splat3((float3)(SHADOW_NOWHERE)), splat3((float3)(-SHADOW_NOWHERE))};
}

static inline float3 box_low(LaneBox box) {
    return (float3)(lane_min(box.low.x), lane_min(box.low.y), lane_min(box.low.z));
}

static inline float3 box_high(LaneBox box) {
    return (float3)(lane_max(box.high.x), lane_max(box.high.y), lane_max(box.high.z));
}

static inline LaneBox grown_box(LaneBox box, MASK mask, FV3 p) {
    box.low =
        select3(mask, fv3(min(box.low.x, p.x), min(box.low.y, p.y), min(box.low.z, p.z)), box.low);
    box.high = select3(mask, fv3(max(box.high.x, p.x), max(box.high.y, p.y), max(box.high.z, p.z)),
                       box.high);
    return box;
}

// A point in the coordinates of edges' forms, see ShadowForm; of a light without a size.
static inline FV3 edge_point(ShadowLight light, FV3 p) {
    if (light.is_direction) return p;
    FV3 d = sub3(p, splat3(light.at));
    return scale3(d, fv(1.0f) / max(size3(d), fv(1e-30f)));
}

// Returns the points of row `row` that face the light and are within its range. The eye must see
// the side of the triangle that the light is on; beyond the range, and a little more, there is no
// light to hide. For lights with a size it also draws each point's target and stores it in ex, ey,
// ez.
static inline MASK face_light(ShadowView view, ShadowPoints* points, uint row, ShadowLight light,
                              MASK wanted) {
    uint at = row * VW;
    FV3 p = load_points(points, row);
    FV3 n = fv3(lane_load(points->nx + at), lane_load(points->ny + at), lane_load(points->nz + at));
    FV3 e = p;
    MASK lit = wanted;
    if (light.is_direction) {
        lit &= lane_mask(dot3(n, splat3(light.at)) > fv(0.0f));
#if AREA_SHADOWS
    } else if (light.is_area) {
        AreaOrigins from = load_area_origins(points, row);
        FV3 to_light = area_targets(light.area, from, wanted);
        e = lane_shadow_point(view, add3(from.position, to_light), 1.0f);
        lit &= lane_mask(dot3(n, sub3(e, p)) > fv(0.0f));
#endif
    } else {
        FV3 d = sub3(p, splat3(light.at));
        lit &= lane_mask(dot3(n, d) < fv(0.0f)) &
               lane_mask(dot3(d, d) * light.inv_range2 < fv(1.001f));
        e = edge_point(light, p);
    }
    lane_store(e.x, points->ex + at);
    lane_store(e.y, points->ey + at);
    lane_store(e.z, points->ez + at);
    lane_store(KX_CONCAT(as_, FV)(lit), points->lit + at);
    return lit;
}

static inline MASK lit_of(const ShadowPoints* points, uint row) {
    return KX_CONCAT(as_, IV)(lane_load(points->lit + row * VW));
}

static inline FV3 load_ray_ends(const ShadowPoints* points, uint row) {
    uint at = row * VW;
    return fv3(lane_load(points->ex + at), lane_load(points->ey + at), lane_load(points->ez + at));
}
#endif
