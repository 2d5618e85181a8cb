// SPDX-License-Identifier: Apache-2.0
// Finds where every pixel's shadow rays end: its point in shadow space, moved onto its triangle's
// plane and then off it towards the eye by more than rounding can move it. So no triangle of a flat
// surface lies between it and a light, and no bias must be chosen.
//
// A point on the plane is off it by no more than the rounding of its triangle's coordinates,
// whatever error the G-buffer's depth has along the ray. The offset is ORIGIN_OFFSET times the size
// of the coordinates: twice the tolerance of shadow_triangle.h in front of a plane.
// One work-item takes VW neighbouring pixels of a row, and their triangles one by one.
#include "kernels/device/lit_item.h"
#include "kernels/device/triangle.h"
#include "kernels/shadows/shadow_space.h"

#define ORIGIN_OFFSET (1.0f / (1 << 18))

// The plane of a caster's triangle, onto which points are moved.
typedef struct OriginPlane {
    float3 corner;  // [m]
    float3 normal;  // unit; 0 where the triangle has no size
    float size;     // largest |x| + |y| + |z| of its corners [m]
} OriginPlane;

static inline float size_of(float3 p) { return fabs(p.x) + fabs(p.y) + fabs(p.z); }

static inline OriginPlane plane_of(global const float* triangle) {
    float3 a = vload3(0, triangle);
    float3 b = vload3(1, triangle);
    float3 c = vload3(2, triangle);
    OriginPlane out;
    out.corner = a;
    out.normal = unit_or_zero(cross_fma(unit_or_zero(b - a), unit_or_zero(c - a)));
    out.size = fmax(size_of(a), fmax(size_of(b), size_of(c)));
    return out;
}

// The direction to the eye: of each pixel, or the same for all in a parallel view.
static inline FV3 towards_eye(View view, ShadowView shadow, FV3 p) {
    if (view.orthographic != 0u) {
        float3 back = shadow_direction(shadow, (float3)(0.0f, 0.0f, 1.0f));
        return fv3(fv(back.x), fv(back.y), fv(back.z));
    }
    return fv3(shadow.shadow_from_view[0].w - p.x, shadow.shadow_from_view[1].w - p.y,
               shadow.shadow_from_view[2].w - p.z);
}

kernel void shadow_origins(
    global const uint* restrict ids,  // [height][stride]: triangle + 1; 0 for background
    GBUFFER_ARGS, ShadowView shadow, SCENE_ARGS,
    global const float* restrict casters,  // [caster_count][3][3], shadow space
    global float* restrict origins) {      // out [ORIGIN_PLANES][height][stride]
    BEGIN_ROW;
    UV id = lane_load(ids + item.pixels.first);
    MASK shown = lane_mask(id != (UV)(0u)) & item.shown;
    if (!lane_any(shown)) return;
    FV3 v = load_position(g, item.pixels, item.z);
    FV3 p = lane_shadow_point(shadow, v, 1.0f);
    FV3 to_eye = towards_eye(view, shadow, p);
    FV3 out = p;
    FV3 normal = to_eye;
    SurfaceScene scene = SCENE_OF_ARGS;
    for (MASK left = shown; lane_any(left);) {
        uint number = first_of(id, left) - 1u;
        MASK mask = lane_mask(id == (UV)(number + 1u)) & shown;
        global const InstanceRow* o = instances + instance_of(scene, number);
        ulong caster = (ulong)o->first_caster + (number - o->first_triangle);
        OriginPlane t = plane_of(casters + caster * 9u);
        FV3 n = fv3(fv(t.normal.x), fv(t.normal.y), fv(t.normal.z));
        FV sign = lane_select(lane_mask(dot3(n, to_eye) < fv(0.0f)), fv(-1.0f), fv(1.0f));
        n = scale3(n, sign);
        FV height = dot3(n, fv3(p.x - t.corner.x, p.y - t.corner.y, p.z - t.corner.z));
        FV size = max(fabs(p.x) + fabs(p.y) + fabs(p.z), fv(t.size));
        FV move = fma(size, fv(ORIGIN_OFFSET), -height);
        out =
            select3(mask, fv3(fma(n.x, move, p.x), fma(n.y, move, p.y), fma(n.z, move, p.z)), out);
        normal = select3(mask, n, normal);
        left &= ~mask;
    }
    uint plane = view.stride * view.height;
    lane_store(out.x, origins + ORIGIN_X * plane + item.pixels.first);
    lane_store(out.y, origins + ORIGIN_Y * plane + item.pixels.first);
    lane_store(out.z, origins + ORIGIN_Z * plane + item.pixels.first);
    lane_store(packed_normal(normal), origins + ORIGIN_NORMAL * plane + item.pixels.first);
}
