// SPDX-License-Identifier: Apache-2.0
#include "host/render/lights/light_rows.h"

#include <algorithm>
#include <cmath>

#include "host/scene/lights/light_kinds.h"
#include "host/scene/lights/light_shape.h"
#include "host/stages/lights/move_lights.h"

namespace kilolux {
namespace {

// Squares of distances to farther positions leave the range for which culling is exact (1e30 m^2,
// kernels/lists/light_reach.h) [m].
constexpr double kFarthest = 1e15;

bool gives_light(const glm::vec3& intensity) {
    return is_finite(glm::dvec3(intensity)) &&
           std::min({intensity.x, intensity.y, intensity.z}) >= 0.0f &&
           std::max({intensity.x, intensity.y, intensity.z}) > 0.0f;
}

bool has_direction(const glm::dvec3& direction) {
    return is_finite(direction) && glm::length(direction) > 1e-12;
}

// Whether its row can hold one over the area, by which intensity becomes luminance.
bool has_good_area(const SceneLight& light) {
    const auto inverse = static_cast<float>(1.0 / seen_area(light));
    return !is_area_light(light) || std::isnormal(inverse);
}

Light row_of(const SceneLight& light, const glm::dvec3& relative) {
    const glm::vec3 p(relative);
    Light row = point_light_rows({p.x, p.y, p.z, light.has_own_range ? light.range : -light.range},
                                 {light.intensity.x, light.intensity.y, light.intensity.z, 0.0f});
    const LightKind& kind = kind_of(light);
    const bool has_half_space = kind.is_flat && !light.two_sided;
    if (!kind.has_cone && !has_half_space) return row;
    const glm::vec3 axis(glm::normalize(light.direction));
    if (has_half_space) {
        row.axis_cos = {axis.x, axis.y, axis.z, 0.0f};
        return row;
    }
    const double cos_out = std::cos(std::min<double>(light.outer_cone, 1.5707963267948966));
    const double cos_in = std::cos(std::clamp<double>(light.inner_cone, 0.0, light.outer_cone));
    // As KHR_lights_punctual: at least 0.001 between the cosines.
    row.color_scale.w = static_cast<float>(1.0 / std::max(0.001, cos_in - cos_out));
    row.axis_cos = {axis.x, axis.y, axis.z, static_cast<float>(cos_out)};
    return row;
}

}  // namespace

// A light with a NaN would spread over all pixels of its lists, and through filters over the
// picture: it is left out and counted. The test is here, in double, since kernels may be built to
// assume that there are none (-cl-finite-math-only, OpenCL C 5.8.4).
bool is_usable(const SceneLight& light, const glm::dvec3& camera_position) {
    if (!gives_light(light.intensity)) return false;
    const LightKind& kind = kind_of(light);
    if ((kind.is_aimed || light.profile >= 0) && !has_direction(light.direction)) return false;
    if (is_area_light(light) && light.profile >= 0) return false;
    const glm::dvec3 relative = light.position - camera_position;
    const bool placed = is_finite(relative) && glm::length(relative) < kFarthest;
    return (placed || !kind.is_placed) && has_good_numbers(light) && has_good_area(light);
}

WorldLight world_light(const SceneLight& light) {
    const glm::dvec3& p = light.position;
    const PointPair pair = point_pair(p.x, p.y, p.z);
    return {row_of(light, p), pair.low};
}

AimedProfile aimed_profile(const SceneLight& light, const Scene& scene,
                           std::span<const float> starts) {
    if (light.profile < 0) return {{0.0f, 0.0f, 0.0f, NO_WEB}, {0.0f, 0.0f, 0.0f, 1.0f}};
    const SceneProfile& profile = scene.aimed_profiles[static_cast<std::size_t>(light.profile)];
    const glm::vec3 down(glm::normalize(light.direction));
    const glm::vec3 side(light.side);
    return {{down.x, down.y, down.z, starts[profile.web]},
            {side.x, side.y, side.z, profile.mirrored ? -1.0f : 1.0f}};
}

LightShape shape_row(const SceneLight& light) {
    const LightKind& kind = kind_of(light);
    if (!is_area_light(light)) return {};
    const LightEdges edges = edges_of(light);
    const glm::vec3 x(kind.has_radius ? glm::dvec3(light.radius, 0.0, 0.0) : edges.x), y(edges.y);
    const float shape = static_cast<float>(kind.shape);
    return {{x.x, x.y, x.z, light.two_sided ? -shape : shape},
            {y.x, y.y, y.z, static_cast<float>(1.0 / seen_area(light))}};
}

DirectionalLight directional_row(const SceneLight& light) {
    const glm::vec3 to_light(-glm::normalize(light.direction));
    return {{to_light.x, to_light.y, to_light.z, 0.0f},
            {light.intensity.x, light.intensity.y, light.intensity.z, 0.0f}};
}

LightRows make_light_rows(std::span<const SceneLight> lights, const glm::dvec3& camera_position) {
    LightRows rows;
    rows.local.reserve(lights.size());
    for (const SceneLight& light : lights) {
        if (!is_usable(light, camera_position)) {
            ++rows.rejected;
            continue;
        }
        add_features(rows.features, light);
        if (kind_of(light).is_placed) {
            rows.local.push_back(row_of(light, light.position - camera_position));
            if (!is_area_light(light)) continue;
            rows.shapes.resize(rows.local.size());
            rows.shapes.back() = shape_row(light);
        } else {
            rows.directional.push_back(directional_row(light));
        }
    }
    if (!rows.shapes.empty()) rows.shapes.resize(rows.local.size());
    return rows;
}

}  // namespace kilolux
