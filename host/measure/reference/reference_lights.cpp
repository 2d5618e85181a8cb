// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/reference_lights.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "host/measure/reference/reference.h"
#include "host/scene/lights/light_kinds.h"
#include "host/scene/lights/light_shape.h"
#include "kernels/shared/lights/light_transform.h"

namespace kilolux {
namespace {

// By SHAPE_* - 1.
constexpr std::array kAreaKinds = {AreaKind::rectangle, AreaKind::disk, AreaKind::sphere,
                                   AreaKind::triangle};

glm::dvec3 xyz(const float4& v) { return {v.x, v.y, v.z}; }

ReferenceLight of_row(const ShadeLight& row) {
    return {.position = xyz(row.position_inv_range2),
            .inv_range2 = inv_range2_of(row),
            .random_range = has_random_range(row),
            .intensity = xyz(row.color_scale),
            .axis = xyz(row.axis_cos),
            .cos_out = row.axis_cos.w,
            .cone_scale = row.color_scale.w};
}

AreaShape shape_of_row(const LightShape& row) {
    AreaShape out;
    out.kind = kAreaKinds.at(shape_kind(row) - 1);
    out.half_x = xyz(row.half_x);
    out.half_y = xyz(row.half_y);
    if (out.kind == AreaKind::sphere) out.radius = glm::length(out.half_x);
    out.two_sided = shines_both_ways(row);
    return out;
}

WebInView web_of(const SceneLight& light, const glm::dmat3& view_from_world, const Scene& scene) {
    const SceneProfile& profile = scene.aimed_profiles[static_cast<std::size_t>(light.profile)];
    return {&scene.webs[profile.web], view_from_world * glm::normalize(light.direction),
            view_from_world * light.side, profile.mirrored};
}

ReferenceLight of_scene(const SceneLight& light, const Camera& camera, const Scene* scene) {
    const glm::dmat3 view_from_world = glm::transpose(camera.world_from_view);
    ReferenceLight out;
    out.position = view_from_world * (light.position - camera.position);
    const double range = light.range;
    out.inv_range2 = range > 0.0 ? 1.0 / (range * range) : 0.0;
    out.intensity = glm::dvec3(light.intensity);
    if (light.profile >= 0 && scene != nullptr) out.web = web_of(light, view_from_world, *scene);
    if (is_area_light(light)) {
        const LightEdges edges = edges_of(light);
        out.shape = AreaShape{.kind = kAreaKinds.at(kind_of(light).shape - 1),
                              .half_x = view_from_world * edges.x,
                              .half_y = view_from_world * edges.y,
                              .radius = light.radius,
                              .two_sided = light.two_sided};
        out.inverse_area = 1.0 / seen_area(light);
    }
    if (kind_of(light).has_cone) {
        out.axis = view_from_world * glm::normalize(light.direction);
        out.cos_out = std::cos(static_cast<double>(light.outer_cone));
        const double cos_in = std::cos(static_cast<double>(light.inner_cone));
        out.cone_scale = 1.0 / std::max(0.001, cos_in - out.cos_out);
    }
    return out;
}

double cone(const ReferenceLight& light, const glm::dvec3& to_light) {
    const double cosine = glm::dot(light.axis, -to_light);
    const double edge = std::clamp((cosine - light.cos_out) * light.cone_scale, 0.0, 1.0);
    return edge * edge;
}

// Repeats random_range_weight() of evaluate.h in double.
double random_range_weight(const ReferenceLight& light, double d2, double random_ranges) {
    const glm::dvec3& i = light.intensity;
    return std::max(1.0, d2 * random_ranges / std::max({i.x, i.y, i.z}));
}

}  // namespace

double window_at(const ReferenceLight& light, const glm::dvec3& position,
                 const ReferenceOptions& options) {
    const glm::dvec3 v = light.position - position;
    const double d2 = glm::dot(v, v);
    const double x = options.windowed ? d2 * light.inv_range2 : 0.0;  // (d / range)^2
    if (x >= 1.0) return 0.0;
    return light.random_range ? random_range_weight(light, d2, options.random_ranges)
                              : (1.0 - x) * (1.0 + x);
}

Incidence incidence(const ReferenceLight& light, const glm::dvec3& position,
                    const ReferenceOptions& options) {
    const glm::dvec3 v = light.position - position;
    const double d2 = glm::dot(v, v);
    const double x = options.windowed ? d2 * light.inv_range2 : 0.0;  // (d / range)^2
    const double window = window_at(light, position, options);
    if (window == 0.0) return {};
    const double d = std::max(std::sqrt(d2), options.light_d_min);
    const glm::dvec3 to_light = v / d;
    const double edge = cone(light, to_light);
    const double share = light.web.web != nullptr ? share_towards(light.web, -to_light) : 1.0;
    return {to_light, window / (d * d) * edge * share,
            x < 1.0 - kReachMargin && edge > kReachMargin && share > kReachMargin};
}

ReferenceLights reference_lights(std::span<const ShadeLight> lights,
                                 std::span<const DirectionalLight> directional,
                                 const ReferenceExtras& extras) {
    ReferenceLights out;
    for (const ShadeLight& row : lights) out.lights.push_back(of_row(row));
    for (std::size_t i = 0; i < extras.webs.size(); ++i) out.lights[i].web = extras.webs[i];
    for (std::size_t i = 0; i < extras.shapes.size(); ++i) {
        if (!has_size(extras.shapes[i])) continue;
        out.lights[i].shape = shape_of_row(extras.shapes[i]);
        out.lights[i].inverse_area = extras.shapes[i].half_y.w;
    }
    for (const DirectionalLight& row : directional) {
        out.directional.push_back({.to_light = xyz(row.to_light), .illuminance = xyz(row.color)});
    }
    return out;
}

ReferenceLights reference_lights(std::span<const SceneLight> lights, const Camera& camera,
                                 const Scene* scene) {
    ReferenceLights out;
    const glm::dmat3 view_from_world = glm::transpose(camera.world_from_view);
    for (const SceneLight& light : lights) {
        if (kind_of(light).is_placed) {
            out.lights.push_back(of_scene(light, camera, scene));
        } else {
            out.directional.push_back(
                {.to_light = view_from_world * -glm::normalize(light.direction),
                 .illuminance = glm::dvec3(light.intensity)});
        }
    }
    return out;
}

}  // namespace kilolux
