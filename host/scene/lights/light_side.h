// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "host/scene/scene.h"

namespace kilolux {

/// The side of a light of this direction (unit): the part of `wanted` (unit) that is perpendicular
/// to it, or any perpendicular vector where `wanted` is parallel to it.
inline glm::dvec3 perpendicular_side(const glm::dvec3& direction,
                                     const glm::dvec3& wanted = SceneLight().side) {
    constexpr double kLeastSine = 1e-6;
    const glm::dvec3 across = wanted - direction * glm::dot(wanted, direction);
    if (glm::length(across) > kLeastSine) return glm::normalize(across);
    const glm::dvec3 aside =
        std::abs(direction.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    return glm::normalize(glm::cross(direction, aside));
}

}  // namespace kilolux
