// SPDX-License-Identifier: Apache-2.0
// Visibility of lights at the VW pixels of one work-item, by a walk for each light: the check of
// cast_shadows, which walks once for all pixels of a cluster.
#ifndef KILOLUX_DEVICE_SHADOW_RAYS_H
#define KILOLUX_DEVICE_SHADOW_RAYS_H
#define SHADOW_POINTS VW
#include "kernels/shadows/shadow_cast.h"

typedef struct ShadowRays {
    ShadowScene scene;
    ShadowPoints* points;
    MASK wanted;  // lanes that cast rays
} ShadowRays;

static inline MASK sees(ShadowRays rays, ShadowLight light) {
    MASK lit = face_light(rays.points, 0u, light, rays.wanted);
    if (!lane_any(lit)) return lit;
    ulong tests_before = counted_tests(rays.points);
    uint count = lane_count(lit);
    LaneBox box = {splat3((float3)(SHADOW_NOWHERE)), splat3((float3)(-SHADOW_NOWHERE))};
    box = grown_box(box, lit, load_points(rays.points, 0u));
    float3 low = (float3)(lane_min(box.low.x), lane_min(box.low.y), lane_min(box.low.z));
    float3 high = (float3)(lane_max(box.high.x), lane_max(box.high.y), lane_max(box.high.z));
    cast_shadows_of(rays.scene, light, low, high, 0u, 1u, rays.points);
    lit = lit_of(rays.points, 0u);
    count_rays(rays.points, tests_before, count, lane_count(lit));
    return lit;
}
#endif
