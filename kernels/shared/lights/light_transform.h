// SPDX-License-Identifier: Apache-2.0
// Camera-relative lights in world axes -> view space.
#ifndef KILOLUX_SHARED_LIGHTS_LIGHT_TRANSFORM_H
#define KILOLUX_SHARED_LIGHTS_LIGHT_TRANSFORM_H
#include "kernels/shared/hash.h"
#include "kernels/shared/light.h"
#include "kernels/shared/light_extras.h"
#include "kernels/shared/view.h"

// Largest 1/range^2 [1/m^2]: a range below 1e-19 m must not become infinity times 0.
#define INV_RANGE2_MAX 1e38f

#if defined(__cplusplus)
namespace kilolux {
#endif

SHARED_FN float rotate_row(float4 row, float4 v) {
    return fma(row.z, v.z, fma(row.y, v.y, row.x * v.x));
}

// xyz of `v` in view axes, and `w`.
SHARED_FN float4 rotated(View view, float4 v, float w) {
    return make_float4(rotate_row(view.view_from_world_x, v), rotate_row(view.view_from_world_y, v),
                       rotate_row(view.view_from_world_z, v), w);
}

SHARED_FN float range_of(Light light) {
    return has_own_range(light) ? light.position_range.w : -light.position_range.w;
}

// 1/range^2, of a random range, too [1/m^2].
SHARED_FN float inv_range2_of(ShadeLight light) {
    float inv = light.position_inv_range2.w;
    return has_random_range(light) ? -inv : inv;
}

// 1/range^2 of light `index`, negative if random. With a seed, lights without a range of their own
// get a random one, r = r0 / sqrt(1 - random): so that a point at distance d > r0 is in range with
// probability (r0 / d)^2 and can weigh the light by its reciprocal, unbiased (Tokuyoshi and Harada
// 2016, "Stochastic Light Culling"). Beyond 4096 r0 none is chosen: 6e-8 of the probability.
SHARED_FN float chosen_inv_range2(Light light, uint index, uint seed) {
    float range = range_of(light);
    float inv = min(1.0f / (range * range), INV_RANGE2_MAX);
    if (seed == 0u || has_own_range(light)) return inv;
    return -inv * (1.0f - random_of(hash_of(hash_of(seed) ^ index)));
}

// `seed`: of random ranges; 0: no range is random.
SHARED_FN ShadeLight shade_light(View view, Light light, uint index, uint seed) {
    ShadeLight local_light;
    local_light.position_inv_range2 =
        rotated(view, light.position_range, chosen_inv_range2(light, index, seed));
    local_light.color_scale = light.color_scale;
#define TURN_ROW(has, feature, member) \
    local_light.member = rotated(view, light.member, light.member.w);
    LIGHT_ROWS(TURN_ROW)
    return local_light;
}

SHARED_FN AimedProfile aimed_in_view(View view, AimedProfile world) {
    AimedProfile out;
    out.down = rotated(view, world.down, world.down.w);
    out.side = rotated(view, world.side, world.side.w);
    return out;
}

SHARED_FN LightShape shape_in_view(View view, LightShape world) {
    LightShape out;
    out.half_x = rotated(view, world.half_x, world.half_x.w);
    out.half_y = rotated(view, world.half_y, world.half_y.w);
    return out;
}

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
