// SPDX-License-Identifier: Apache-2.0
// Visibility of lights at the VW pixels of one work-item, by a walk for each light: the check of
// cast_shadows, which walks once for all pixels of a cluster. With TINTED_SHADOWS also what
// surfaces between let through.
#ifndef KILOLUX_DEVICE_SHADOW_RAYS_H
#define KILOLUX_DEVICE_SHADOW_RAYS_H
#define SHADOW_POINTS VW
#include "kernels/shadows/shadow_cast.h"

typedef struct ShadowRays {
    ShadowScene scene;
    ShadowPoints* points;
    MASK wanted;  // lanes that cast rays
} ShadowRays;

// Walks for the points `lit`, which face_light() began.
static inline void walk_to(ShadowRays rays, ShadowLight light, MASK lit) {
    LaneBox box = grown_box(no_box(), lit, load_points(rays.points, 0u));
#if AREA_SHADOWS
    if (light.is_area) {
        LaneBox ends = grown_box(no_box(), lit, load_ray_ends(rays.points, 0u));
        light.area.low = box_low(ends);
        light.area.high = box_high(ends);
    }
#endif
    cast_shadows_of(rays.scene, light, box_low(box), box_high(box), 0u, 1u, rays.points);
}

static inline MASK sees(ShadowRays rays, ShadowLight light) {
    MASK lit = face_light(rays.scene.view, rays.points, 0u, light, rays.wanted);
    if (!lane_any(lit)) return lit;
    ulong tests_before = counted_tests(rays.points);
    uint count = lane_count(lit);
    walk_to(rays, light, lit);
    lit = lit_of(rays.points, 0u);
    count_rays(rays.points, tests_before, count, lane_count(lit));
    return lit;
}

#if TINTED_SHADOWS
// The points of rays.wanted whose light passes surfaces that tint it, and what passes. `rays`: of a
// tinting_scene().
static inline MASK tinted(ShadowRays rays, ShadowLight light, FV3* share) {
    rays.points->tints = (TintSums){(UV)(0u), (UV)(0u), (UV)(0u)};
    MASK lit = face_light(rays.scene.view, rays.points, 0u, light, rays.wanted);
    if (rays.scene.view.tint_root != 0u && lane_any(lit)) walk_to(rays, light, lit);
    TintSums sums = rays.points->tints;
    *share = fv3(share_of_units(sums.red), share_of_units(sums.green), share_of_units(sums.blue));
    return lane_mask((sums.red | sums.green | sums.blue) != (UV)(0u));
}
#endif
#endif
