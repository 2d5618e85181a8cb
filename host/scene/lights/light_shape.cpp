// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/light_shape.h"

#include <algorithm>
#include <numbers>

#include "host/scene/lights/light_kinds.h"

namespace kilolux {

LightEdges edges_of(const SceneLight& light) {
    if (!kind_of(light).is_flat) return {};
    const glm::dvec3 direction = glm::normalize(light.direction);
    const glm::dvec3 across = glm::cross(direction, light.side);
    if (kind_of(light).has_skew) {
        return {double{light.width} * light.side,
                double{light.skew} * light.side + double{light.height} * across};
    }
    return {0.5 * double{light.width} * light.side, 0.5 * double{light.height} * across};
}

std::array<glm::dvec3, 3> corners_of(const glm::dvec3& centroid, const LightEdges& edges) {
    const glm::dvec3 first = centroid - (edges.x + edges.y) / 3.0;
    return {first, first + edges.x, first + edges.y};
}

double seen_area(const SceneLight& light) {
    const double box = double{light.width} * double{light.height};
    switch (light.type) {
        case LightType::rectangle:
            return box;
        case LightType::disk:
            return 0.25 * std::numbers::pi * box;
        case LightType::triangle:
            return 0.5 * box;
        case LightType::sphere:
            return std::numbers::pi * double{light.radius} * double{light.radius};
        default:
            return 0.0;
    }
}

double bounding_radius(const SceneLight& light) {
    const LightEdges edges = edges_of(light);
    switch (light.type) {
        case LightType::rectangle:
            return glm::length(edges.x + edges.y);
        case LightType::disk:
            return std::max(glm::length(edges.x), glm::length(edges.y));
        case LightType::triangle:
            return std::max({glm::length(edges.x + edges.y), glm::length(2.0 * edges.x - edges.y),
                             glm::length(2.0 * edges.y - edges.x)}) /
                   3.0;
        case LightType::sphere:
            return light.radius;
        default:
            return 0.0;
    }
}

void set_triangle(SceneLight& light, const glm::dvec3& a, const glm::dvec3& b,
                  const glm::dvec3& c) {
    const glm::dvec3 x = b - a, y = c - a, normal = glm::cross(x, y);
    const double area2 = glm::length(normal), width = glm::length(x);
    light.type = LightType::triangle;
    light.position = a + (x + y) / 3.0;
    light.width = static_cast<float>(width);
    light.direction = glm::dvec3(0.0);
    light.height = light.skew = 0.0f;
    if (!(area2 > 0.0)) return;
    light.direction = normal / area2;
    light.side = x / width;
    light.height = static_cast<float>(area2 / width);
    light.skew = static_cast<float>(glm::dot(y, light.side));
}

void set_point_size(SceneLight& light, double radius) {
    const bool is_point = light.type == LightType::point && light.profile < 0;
    if (!is_point && !light.is_sized_point) return;
    light.is_sized_point = radius > 0.0;
    light.type = light.is_sized_point ? LightType::sphere : LightType::point;
    light.radius = static_cast<float>(radius);
}

void set_rectangle(SceneLight& light, const glm::dvec3& corner, const glm::dvec3& x,
                   const glm::dvec3& y) {
    const double width = glm::length(x);
    light.type = LightType::rectangle;
    light.position = corner + 0.5 * (x + y);
    light.side = x / width;
    light.direction = glm::normalize(glm::cross(x, y));
    light.width = static_cast<float>(width);
    light.height = static_cast<float>(glm::length(y));
}

}  // namespace kilolux
