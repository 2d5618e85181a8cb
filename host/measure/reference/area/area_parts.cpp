// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/area/area_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/scene/lights/light_shape.h"

namespace kilolux {
namespace {

using glm::dvec3;

constexpr double kPi = std::numbers::pi;

// Of a sphere in the direction of its centre: u in equal steps of the cosine, v around it.
AreaPart sphere_part(const AreaShape& shape, double u, double v, double count) {
    const double distance = glm::length(shape.center), sine = shape.radius / distance;
    const dvec3 axis = shape.center / distance;
    const dvec3 aside = std::abs(axis.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 x = glm::normalize(glm::cross(axis, aside)), y = glm::cross(axis, x);
    const double cone = sine * sine / (1.0 + std::sqrt(1.0 - sine * sine));  // 1 - cosine
    const double cosine = 1.0 - u * cone, across = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    const dvec3 way =
        cosine * axis + across * (std::cos(2 * kPi * v) * x + std::sin(2 * kPi * v) * y);
    const double miss = distance * across;
    const double in = std::sqrt(std::max(0.0, shape.radius * shape.radius - miss * miss));
    return {way * (distance * cosine - in), 2 * kPi * cone / count};
}

// The point at (u, v) of a flat shape, in the square from 0 to 1.
dvec3 flat_point(const AreaShape& shape, double u, double v) {
    const dvec3 &x = shape.half_x, &y = shape.half_y;
    if (shape.kind == AreaKind::disk) {
        const double r = std::sqrt(u), angle = 2 * kPi * v;
        return shape.center + r * std::cos(angle) * x + r * std::sin(angle) * y;
    }
    if (shape.kind == AreaKind::triangle) {
        const double s = std::sqrt(u);
        return corners_of(shape.center, {x, y})[0] + s * (1.0 - v) * x + s * v * y;
    }
    return shape.center + (2 * u - 1) * x + (2 * v - 1) * y;
}

double area_of(const AreaShape& shape) {
    const double across = glm::length(glm::cross(shape.half_x, shape.half_y));
    if (shape.kind == AreaKind::disk) return kPi * across;
    return (shape.kind == AreaKind::triangle ? 0.5 : 4.0) * across;
}

AreaPart flat_part(const AreaShape& shape, double u, double v, double count) {
    AreaPart part{.to_light = flat_point(shape, u, v)};
    const double distance = glm::length(part.to_light);
    const dvec3 normal = glm::normalize(glm::cross(shape.half_x, shape.half_y));
    const double facing = -glm::dot(normal, part.to_light) / distance;
    const double cosine = shape.two_sided ? std::abs(facing) : std::max(facing, 0.0);
    part.solid_angle = area_of(shape) / count * cosine / (distance * distance);
    return part;
}

}  // namespace

std::vector<AreaPart> parts_of(const AreaShape& shape, int steps) {
    std::vector<AreaPart> parts;
    const bool is_sphere = shape.kind == AreaKind::sphere;
    if (is_sphere && glm::length(shape.center) <= shape.radius) return parts;
    const double count = static_cast<double>(steps) * steps;
    for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) {
            const double u = (i + 0.5) / steps, v = (j + 0.5) / steps;
            parts.push_back(is_sphere ? sphere_part(shape, u, v, count)
                                      : flat_part(shape, u, v, count));
        }
    }
    return parts;
}

}  // namespace kilolux
