// SPDX-License-Identifier: Apache-2.0
// Triangles -> affine functions of a pixel's ray, VW at once: see raster_triangle.h.
#ifndef KILOLUX_DEVICE_RASTER_SET_UP_H
#define KILOLUX_DEVICE_RASTER_SET_UP_H
#include "kernels/device/longest_edge.h"
#include "kernels/surfaces/raster_triangle.h"

// Triangles as the eye sees them.
typedef struct ViewTriangles {
    FV3 v[3];  // [m]
    // The visible winding: -1 or 1; 0: both are.
    IV winding;
    MASK masked;  // by their material's alpha
} ViewTriangles;

static inline FV lane_row_times(float4 row, FV3 v) {
    return fma(fv(row.z), v.z, fma(fv(row.y), v.y, row.x * v.x));
}

// view_vertex() in lanes.
static inline FV3 view_vertices(global const InstanceRow* o, FV3 p) {
    FV3 from_eye = fv3((p.x - o->eye_high.x) - o->eye_low.x, (p.y - o->eye_high.y) - o->eye_low.y,
                       (p.z - o->eye_high.z) - o->eye_low.z);
    return fv3(lane_row_times(o->view_from_object[0], from_eye) + o->view_from_object[0].w,
               lane_row_times(o->view_from_object[1], from_eye) + o->view_from_object[1].w,
               lane_row_times(o->view_from_object[2], from_eye) + o->view_from_object[2].w);
}

// Corner `corner` of triangles of one mesh, by their numbers in it.
static inline FV3 object_vertices(SurfaceScene scene, MeshRow mesh, UV triangles, uint corner) {
    float x[VW], y[VW], z[VW];
    uint place[VW];
    lane_store(mesh.first_index + 3u * triangles + corner, place);
#pragma unroll
    for (uint i = 0; i < VW; ++i) {
        global const float* vertex = scene.vertices + mesh.first_float +
                                     (size_t)scene.indices[place[i]] * mesh.vertex_floats;
        x[i] = vertex[0];
        y[i] = vertex[1];
        z[i] = vertex[2];
    }
    return fv3(lane_load(x), lane_load(y), lane_load(z));
}

// Triangles by their numbers along the instances, where `wanted`; the others have no size.
static inline ViewTriangles view_triangles(SurfaceScene scene, UV numbers, MASK wanted) {
    ViewTriangles out;
    out.v[0] = out.v[1] = out.v[2] = fv3(fv(0.0f), fv(0.0f), fv(0.0f));
    out.winding = (IV)(0);
    out.masked = (MASK)(0);
    for (MASK left = wanted; lane_any(left);) {
        uint first = first_of(numbers, left);
        global const InstanceRow* o = scene.instances + instance_of(scene, first);
        MASK mask = left & lane_mask(numbers >= (UV)(o->first_triangle)) &
                    lane_mask(numbers < (UV)(o[1].first_triangle));
        MeshRow mesh = scene.meshes[o->mesh];
        UV in_mesh = select((UV)(first), numbers, mask) - o->first_triangle;
        for (uint i = 0; i < 3; ++i) {
            FV3 v = view_vertices(o, object_vertices(scene, mesh, in_mesh, i));
            out.v[i] = select3(mask, v, out.v[i]);
        }
        uint flags = scene.materials[mesh.material].flags;
        // Seen from the front, counter-clockwise triangles have a negative determinant.
        int front = HANDEDNESS(*o) < 0.0f ? 1 : -1;
        int winding = (flags & MATERIAL_DOUBLE_SIDED) != 0u ? 0 : front;
        out.winding = (mask & winding) | (~mask & out.winding);
        if ((flags & MATERIAL_MASKED) != 0u) out.masked |= mask;
        left &= ~mask;
    }
    return out;
}

// The ray of the upper left corner of a pixel of the planes.
static inline float2 corner_ray(View view, uint x, uint y) {
    return (float2)(fma((float)(view.first_column + x), view.ray.x, view.ray.y),
                    fma((float)(view.first_row + y), view.ray.z, view.ray.w));
}

// The largest |x| and |y| of the rays of the planes' pixels.
static inline float2 ray_span(View view) {
    return fmax(fabs(corner_ray(view, 0u, 0u)), fabs(corner_ray(view, view.width, view.height)));
}

// a x b, scaled so that the sign of its product with a ray is certain beyond +-1. `size`: the
// product of both vectors' sums of magnitudes.
static inline FV3 sure_edge(FV3 a, FV3 b, FV size, float2 span) {
    FV3 s = add3(a, b);
    FV3 d = sub3(b, a);
    FV3 e = cross3(s, d);
    FV x = fabs(s.y * d.z) + fabs(s.z * d.y);
    FV y = fabs(s.z * d.x) + fabs(s.x * d.z);
    FV z = fabs(s.x * d.y) + fabs(s.y * d.x);
    FV products = fma(x, fv(span.x), fma(y, fv(span.y), z));
    float longest = fmax(1.0f, fmax(span.x, span.y));
    FV unit = fma(size, fv(longest * CUT_SHARE), products * SURE_SHARE);
    return scale3(e, fv(1.0f) / max(unit, fv(1e-36f)));
}

typedef struct RasterTriangles {
    FV3 edge[3];           // scaled, positive inside
    FV3 plane;             // key = plane.x ray.x + plane.y ray.y - plane.z
    FV farthest, nearest;  // the vertices' keys; nearest is infinite behind the eye
} RasterTriangles;

static inline float3 lane_vertex(const FV3* v, uint lane) {
    float x[VW], y[VW], z[VW];
    lane_store(v->x, x);
    lane_store(v->y, y);
    lane_store(v->z, z);
    return (float3)(x[lane], y[lane], z[lane]);
}

// Signs of the determinants where floats are uncertain; 0 where the eye lies in the plane.
static inline FV exact_determinants(const FV3* seen, MASK unsure, FV sign) {
    float out[VW];
    int ask[VW];
    lane_store(sign, out);
    lane_store(unsure, ask);
    for (uint i = 0; i < VW; ++i) {
        if (ask[i] == 0) continue;
        Fixed3 a = fixed_of(lane_vertex(seen, i));
        Fixed3 b = fixed_of(lane_vertex(seen + 1, i));
        out[i] = (float)sign_along(wide_cross(a, b), fixed_of(lane_vertex(seen + 2, i)));
    }
    return lane_load(out);
}

// The determinant's sign, and whether its float is accurate enough for more.
typedef struct Facing {
    FV3 normal;  // (v1 - v0) x (v2 - v0)
    FV determinant;
    FV sign;
    MASK unsure;
} Facing;

// `seen`: turned.
static inline Facing facing_of(const FV3* seen) {
    Facing out;
    FV3 a = sub3(seen[1], seen[0]);
    FV3 b = sub3(seen[2], seen[0]);
    out.normal = cross3(a, b);
    out.determinant = dot3(out.normal, seen[0]);
    FV size0 = size3(seen[0]);
    FV products = size3(a) * size3(b) * size0;
    FV size = size0 * size3(seen[1]) * size3(seen[2]);
    FV unit = max(fma(size, fv(CUT_SHARE), products * SURE_SHARE), fv(1e-36f));
    out.unsure = lane_mask(!(fabs(out.determinant) > unit));
    out.sign = lane_select(lane_mask(out.determinant < fv(0.0f)), fv(-1.0f), fv(1.0f));
    if (lane_any(out.unsure)) out.sign = exact_determinants(seen, out.unsure, out.sign);
    return out;
}

// Whether the triangles are visible from that side, and have an area.
static inline MASK shows_side(FV sign, IV winding) {
    MASK any_side = lane_mask(winding == (IV)(0)) & lane_mask(sign != fv(0.0f));
    return any_side | (lane_mask(winding < 0) & lane_mask(sign < fv(0.0f))) |
           (lane_mask(winding > 0) & lane_mask(sign > fv(0.0f)));
}

// Keys of vertices in front of the eye.
typedef struct VertexKeys {
    FV k[3];
    MASK crosses;  // some are not in front
} VertexKeys;

static inline VertexKeys vertex_keys(View view, const FV3* v) {
    VertexKeys out;
    out.crosses = (MASK)(0);
    for (uint i = 0; i < 3; ++i) {
        if (view.orthographic != 0u) {
            out.k[i] = v[i].z;
            continue;
        }
        MASK behind = lane_mask(!(v[i].z < fv(-1e-25f)));
        out.k[i] = lane_select(behind, fv(INFINITY), lane_reciprocal(-v[i].z));
        out.crosses |= behind;
    }
    return out;
}

static inline FV3 key_plane(View view, const FV3* v, Facing facing) {
    FV3 plane;
    if (view.orthographic == 0u) {
        plane = scale3(facing.normal, lane_reciprocal(facing.determinant));
    } else {
        FV3 n = cross3(sub3(v[1], v[0]), sub3(v[2], v[0]));
        FV inv = lane_reciprocal(n.z);
        plane.x = -(n.x * inv);
        plane.y = -(n.y * inv);
        plane.z = fma(plane.x, v[0].x, fma(plane.y, v[0].y, -v[0].z));
    }
    return plane;
}

// `v`: rotated by turn_from_longest(); `seen`: the same as the eye sees them.
static inline RasterTriangles affine_functions(View view, const FV3* v, const FV3* seen,
                                               Facing facing) {
    RasterTriangles out;
    float2 span = ray_span(view);
    FV size[3];
    for (uint i = 0; i < 3; ++i) size[i] = size3(seen[i]);
    VertexKeys keys = vertex_keys(view, v);
    out.edge[0] = scale3(sure_edge(seen[1], seen[2], size[1] * size[2], span), facing.sign);
    out.edge[1] = scale3(sure_edge(seen[2], seen[0], size[2] * size[0], span), facing.sign);
    out.edge[2] = scale3(sure_edge(seen[0], seen[1], size[0] * size[1], span), facing.sign);
    out.nearest = max(max(keys.k[0], keys.k[1]), keys.k[2]);
    out.farthest = min(min(keys.k[0], keys.k[1]), keys.k[2]);
    // A plane seen edge-on has no depth: the whole triangle counts as near as its nearest or
    // farthest vertex.
    FV3 flat = fv3(fv(0.0f), fv(0.0f), -lane_select(keys.crosses, out.farthest, out.nearest));
    out.plane = select3(facing.unsure, flat, key_plane(view, v, facing));
    return out;
}

// The pixels that a triangle may cover: columns and rows of the planes, ends included.
typedef struct PixelBounds {
    IV x0, x1, y0, y1;
} PixelBounds;

// The pixel centres from `low` to `high` [pixel], and a little more, within 0 .. count - 1.
static inline void centres_between(FV low, FV high, float slack, float count, IV* first, IV* last) {
    FV least = min(max(ceil(low - (0.5f + slack)), fv(0.0f)), fv(count));
    FV most = min(max(floor(high - (0.5f - slack)), fv(-1.0f)), fv(count - 1.0f));
    *first = lane_to_int(least);
    *last = lane_to_int(most);
}

// Whether a triangle lies outside one side of the pyramid that the rays fill, also where it crosses
// the eye's plane: points in front with x <= most * depth are a half-space.
static inline MASK outside_side(const FV3* seen, const FV* along, float most, float sign) {
    MASK outside = (MASK)(-1);
    for (uint i = 0; i < 3; ++i) {
        FV limit = -seen[i].z * most;
        FV slack = (fabs(along[i]) + fabs(limit)) * SURE_SHARE;
        outside &= lane_mask((along[i] - limit) * sign > slack);
    }
    return outside;
}

static inline MASK outside_view(View view, const FV3* seen) {
    float2 low = corner_ray(view, 0u, view.height);
    float2 high = corner_ray(view, view.width, 0u);
    FV x[3] = {seen[0].x, seen[1].x, seen[2].x};
    FV y[3] = {seen[0].y, seen[1].y, seen[2].y};
    return outside_side(seen, x, low.x, -1.0f) | outside_side(seen, x, high.x, 1.0f) |
           outside_side(seen, y, low.y, -1.0f) | outside_side(seen, y, high.y, 1.0f);
}

// All pixels for triangles that cross the eye's plane. Vertices as float pixels err by less than
// the slack.
static inline PixelBounds pixel_bounds(View view, const FV3* v) {
    VertexKeys keys = vertex_keys(view, v);
    float2 inv = (float2)(1.0f / view.ray.x, 1.0f / view.ray.z);
    FV3 at[3];
    for (uint i = 0; i < 3; ++i) {
        FV k = view.orthographic != 0u ? fv(1.0f) : keys.k[i];
        at[i].x = (fma(v[i].x, k, fv(-view.ray.y))) * inv.x - (float)view.first_column;
        at[i].y = (fma(v[i].y, k, fv(-view.ray.w))) * inv.y - (float)view.first_row;
    }
    FV x0 = min(min(at[0].x, at[1].x), at[2].x);
    FV x1 = max(max(at[0].x, at[1].x), at[2].x);
    FV y0 = min(min(at[0].y, at[1].y), at[2].y);
    FV y1 = max(max(at[0].y, at[1].y), at[2].y);
    float width = (float)view.width;
    float height = (float)view.height;
    float2 pixels = ray_span(view) * fabs(inv);
    float slack = 0.015625f + 2.0f * SURE_SHARE * (pixels.x + pixels.y);
    x0 = lane_select(keys.crosses, fv(0.0f), x0);
    y0 = lane_select(keys.crosses, fv(0.0f), y0);
    x1 = lane_select(keys.crosses, fv(width), x1);
    y1 = lane_select(keys.crosses, fv(height), y1);
    PixelBounds out;
    centres_between(x0, x1, slack, width, &out.x0, &out.x1);
    centres_between(y0, y1, slack, height, &out.y0, &out.y1);
    return out;
}

static inline MASK is_empty_bounds(PixelBounds b) {
    return lane_mask(b.x0 > b.x1) | lane_mask(b.y0 > b.y1);
}

// Triangles while they are set up.
typedef struct SetUp {
    MASK kept;    // some pixel may show them; the rest is undefined otherwise
    MASK masked;  // by alpha
    PixelBounds bounds;
    RasterTriangles triangles;
} SetUp;

// Triangles by their numbers along the instances, where `wanted`.
static inline SetUp set_up_triangles(SurfaceScene scene, View view, UV numbers, MASK wanted) {
    SetUp out;
    ViewTriangles t = view_triangles(scene, numbers, wanted);
    out.masked = t.masked;
    out.bounds = pixel_bounds(view, t.v);
    out.kept = wanted & ~is_empty_bounds(out.bounds);
    if (!lane_any(out.kept)) return out;
    FV3 seen[3];
    turn_from_longest(t.v);
    for (uint i = 0; i < 3; ++i) seen[i] = seen_vertex(view, t.v[i]);
    out.kept &= ~outside_view(view, seen);
    if (!lane_any(out.kept)) return out;
    Facing facing = facing_of(seen);
    out.kept &= shows_side(facing.sign, t.winding);
    if (lane_any(out.kept)) out.triangles = affine_functions(view, t.v, seen, facing);
    return out;
}

static inline void store3(FV3 v, float (*to)[VW]) {
    lane_store(v.x, to[0]);
    lane_store(v.y, to[1]);
    lane_store(v.z, to[2]);
}

// The lanes of a SetUp, one after another.
typedef struct SetUpLanes {
    float affine[14][VW];  // as in RasterRow
    uint x0[VW], x1[VW], y0[VW], y1[VW];
    int kept[VW], masked[VW];
} SetUpLanes;

static inline void store_lanes(const SetUp* s, SetUpLanes* out) {
    for (uint i = 0; i < 3; ++i) store3(s->triangles.edge[i], out->affine + 3 * i);
    store3(s->triangles.plane, out->affine + 9);
    lane_store(s->triangles.farthest, out->affine[12]);
    lane_store(s->triangles.nearest, out->affine[13]);
    lane_store(KX_CONCAT(as_, UV)(s->bounds.x0), out->x0);
    lane_store(KX_CONCAT(as_, UV)(s->bounds.x1), out->x1);
    lane_store(KX_CONCAT(as_, UV)(s->bounds.y0), out->y0);
    lane_store(KX_CONCAT(as_, UV)(s->bounds.y1), out->y1);
    lane_store(s->kept, out->kept);
    lane_store(s->masked, out->masked);
}

static inline RasterRow raster_row(const SetUpLanes* s, uint lane) {
    RasterRow out;
    for (uint i = 0; i < 9; ++i) out.edge[i] = s->affine[i][lane];
    for (uint i = 0; i < 3; ++i) out.plane[i] = s->affine[9 + i][lane];
    out.farthest = s->affine[12][lane];
    out.nearest = s->affine[13][lane];
    out.columns = s->x0[lane] | s->x1[lane] << 16;
    out.rows = s->y0[lane] | s->y1[lane] << 16;
    return out;
}
#endif
