// SPDX-License-Identifier: Apache-2.0
// Compiles evaluate.h with counting lanes into namespace COUNTED, with the switches that are
// defined. Included once for every set of switches, so there is no include guard.
#undef KILOLUX_SHARED_EVALUATE_H
#undef KILOLUX_SHARED_LIGHT_H
#undef KILOLUX_SHARED_LOBES_GGX_H
#undef KILOLUX_SHARED_LOBES_LIGHT_SUM_H
#undef KILOLUX_SHARED_LOBES_PASSED_LIGHT_H
#undef KILOLUX_SHARED_LOBES_PBR_H
#undef KILOLUX_SHARED_LOBES_SHEEN_H
#undef KILOLUX_SHARED_POWER_H
#undef KILOLUX_SHARED_SURFACE_H
#undef F0_VARIES
#undef HAS_COAT
#undef HAS_SHEEN_LOBE
#undef EARLY_OUT
namespace COUNTED {
using namespace counting;
}
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"
#define kilolux COUNTED
#include "kernels/shared/evaluate.h"
#undef kilolux
#pragma GCC diagnostic pop
namespace COUNTED {

// `cover`: of its coat and sheen.
inline ShadingPoint some_point(float cover = 0.5f) {
    const FV3 normal = {fv(0.0f), fv(0.0f), fv(1.0f)};
    Surface surface{};
    surface.position = {fv(0.1f), fv(0.2f), fv(-3.0f)};
    surface.normal = normal;
    surface.roughness = surface.coat_roughness = surface.sheen_roughness = fv(0.5f);
    surface.coat_normal = normal;
    surface.coat = fv(cover);
    surface.sheen = {fv(cover), fv(cover), fv(cover)};
    surface.tangent = {fv(1.0f), fv(0.0f), fv(0.0f)};
    surface.anisotropy = fv(0.5f);
    return make_shading_point(surface, false);
}

// A sum in progress: adding to it counts.
inline LightSum some_sum() {
    LightSum sum = zero_sum();
    for (FV3* part : {&sum.diffuse, &sum.specular})
        for (FV* component : {&part->x, &part->y, &part->z}) component->varies = true;
    return sum;
}

// One light that is `distance` in front of the surface, of range 1.
inline kilolux::InstructionCounts count_evaluation_of(const ShadingPoint& point, float distance) {
    ShadeLight light{};
    light.position_inv_range2 = varying4(0.1f, 0.2f, -3.0f + distance, 1.0f);
    light.color_scale = varying4(1.0f, 1.0f, 1.0f, 1.0f);
    light.axis_cos = varying4(0.0f, 0.0f, -1.0f, 0.5f);
    const LightSum sum = some_sum();
    counts = {};
    evaluate(sum, point, light);
    return counts.instructions;
}

inline kilolux::InstructionCounts count_evaluation(float distance) {
    return count_evaluation_of(some_point(), distance);
}

inline kilolux::InstructionCounts count_directional() {
    const ShadingPoint point = some_point();
    DirectionalLight light{};
    light.to_light = varying4(0.0f, 0.6f, 0.8f, 0.0f);
    light.color = varying4(1.0f, 1.0f, 1.0f, 1.0f);
    const LightSum sum = some_sum();
    counts = {};
    evaluate_directional(sum, point, light);
    return counts.instructions;
}

}  // namespace COUNTED
#undef COUNTED
