// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/reference_lights.h"

#include <algorithm>
#include <cmath>

namespace kilolux {
namespace {

glm::dvec3 xyz(const float4& v) { return {v.x, v.y, v.z}; }

ReferenceLight of_row(const ShadeLight& row) {
    return {.position = xyz(row.position_inv_range2),
            .inv_range2 = row.position_inv_range2.w,
            .intensity = xyz(row.color_scale),
            .axis = xyz(row.axis_cos),
            .cos_out = row.axis_cos.w,
            .cone_scale = row.color_scale.w};
}

ReferenceLight of_scene(const SceneLight& light, const Camera& camera) {
    const glm::dmat3 view_from_world = glm::transpose(camera.world_from_view);
    ReferenceLight out;
    out.position = view_from_world * (light.position - camera.position);
    const double range = light.range;
    out.inv_range2 = range > 0.0 ? 1.0 / (range * range) : 0.0;
    out.intensity = glm::dvec3(light.intensity);
    if (light.type == LightType::spot) {
        out.axis = view_from_world * glm::normalize(light.direction);
        out.cos_out = std::cos(static_cast<double>(light.outer_cone));
        const double cos_in = std::cos(static_cast<double>(light.inner_cone));
        out.cone_scale = 1.0 / std::max(0.001, cos_in - out.cos_out);
    }
    return out;
}

}  // namespace

ReferenceLights reference_lights(std::span<const ShadeLight> lights,
                                 std::span<const DirectionalLight> directional) {
    ReferenceLights out;
    for (const ShadeLight& row : lights) out.lights.push_back(of_row(row));
    for (const DirectionalLight& row : directional) {
        out.directional.push_back({.to_light = xyz(row.to_light), .illuminance = xyz(row.color)});
    }
    return out;
}

ReferenceLights reference_lights(std::span<const SceneLight> lights, const Camera& camera) {
    ReferenceLights out;
    const glm::dmat3 view_from_world = glm::transpose(camera.world_from_view);
    for (const SceneLight& light : lights) {
        if (light.type == LightType::directional) {
            out.directional.push_back(
                {.to_light = view_from_world * -glm::normalize(light.direction),
                 .illuminance = glm::dvec3(light.intensity)});
        } else {
            out.lights.push_back(of_scene(light, camera));
        }
    }
    return out;
}

}  // namespace kilolux
