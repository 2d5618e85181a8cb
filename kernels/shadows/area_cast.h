// SPDX-License-Identifier: Apache-2.0
// Tests of triangles on rays whose ends at the light differ. A triangle is set up for each ray, so
// that a ray's result is the same as if all rays had its end in common.
#ifndef KILOLUX_DEVICE_AREA_CAST_H
#define KILOLUX_DEVICE_AREA_CAST_H
#include "kernels/shadows/shadow_points.h"
#include "kernels/shadows/shadow_scene.h"
#include "kernels/shadows/shadow_shaft.h"

#if AREA_SHADOWS
// The part of `shaded`, of rays that pass the triangle's box, where it hides the lane's target. v:
// its corners, in all lanes.
static inline MASK hidden_in_box(const FV3* v, uint child, ShadowScene scene, LaneLight light,
                                 FV3 point, MASK shaded) {
    MASK sure;
    ShadowTriangles t = set_up_shadow(v, light, scene.view.extent, &sure);
    FV3 d = sub3(point, light.at);
    d = scale3(d, fv(1.0f) / max(size3(d), fv(1e-30f)));
    FV u[3];
    for (uint i = 0; i < 3; ++i) u[i] = dot3(t.edge[i].g, d);
    FV behind = dot3(t.plane.g, point) + t.plane.c;
    shaded &= sure & lane_mask(min(min(u[0], u[1]), min(u[2], behind)) >= fv(-1.0f));
#if HAS_MASKED_CASTERS
    if ((child & SHADOW_MASKED) != 0u && lane_any(shaded)) {
        CasterWeights w = caster_weights(u[0] * t.unit[0], u[1] * t.unit[1], u[2] * t.unit[2]);
        shaded &= is_opaque_at(scene.masked, child & SHADOW_NUMBER, w);
    }
#endif
    return shaded;
}

// The part of `lit` that a triangle hides from the lane's target.
static inline MASK hidden_by(const FV3* v, uint child, ShadowScene scene, LaneLight light,
                             FV3 point, MASK lit) {
    MASK shaded = lit & passes_box(light, point, boxes_of(v));
    return lane_any(shaded) ? hidden_in_box(v, child, scene, light, point, shaded) : shaded;
}

// Tests one triangle on the rays of all rows with lit points.
static inline void shade_targets(const FV3* v, uint child, ShadowScene scene, ShadowLight light,
                                 ShadowPoints* points) {
    uint count = 0;
    LaneLight at = shared_light(light);
    for (uint i = 0; i < points->row_count; ++i) {
        uint row = points->rows[i];
        MASK lit = lit_of(points, row);
        ADD_COUNT(points, points, lane_count(lit));
        at.at = load_ray_ends(points, row);
        lit &= ~hidden_by(v, child, scene, at, load_points(points, row), lit);
        lane_store(KX_CONCAT(as_, FV)(lit), points->lit + row * VW);
        points->rows[count] = (uchar)row;
        count += lane_any(lit) ? 1u : 0u;
    }
    points->row_count = count;
}

// Tests triangles that the walk found.
static inline void shade_found_targets(ShadowScene scene, ShadowLight light, Shaft shaft,
                                       const uint* found, uint count, ShadowPoints* points) {
    for (uint first = 0; first < count; first += VW) {
        FV3 v[3];
        load_casters(scene, found + first, v);
        uint bits =
            lane_ballot(may_part(shaft, light, v) & lane_mask(lane_numbers < (UV)(count - first)));
        for (; bits != 0u; bits &= bits - 1u) {
            uint child = found[first + lowest_bit(bits)];
            global const float* t = scene.casters + (ulong)caster_of(scene, child) * 9u;
            const FV3 one[3] = {splat3(vload3(0, t)), splat3(vload3(1, t)), splat3(vload3(2, t))};
            shade_targets(one, child, scene, light, points);
        }
    }
}
#endif
#endif
