// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace kilolux {

/// A place whose illuminance is asked.
struct MeasuringPoint {
    glm::dvec3 position{0.0};          // [m], world
    glm::dvec3 normal{0.0, 1.0, 0.0};  // unit, world: of the surface that is lit
    bool operator==(const MeasuringPoint&) const = default;
};

/// Points and lights are nearer than this to the origin: squares of greater distances leave the
/// range of the kernels' tests (host/render/lights/light_rows.cpp) [m].
inline constexpr double kFarthestPoint = 1e15;

/// Points of a group: the pixels of a fine tile.
inline constexpr std::size_t kGroupPoints = 256;

/// The points' numbers, ordered so that each kGroupPoints that follow each other lie close
/// together: the set is halved along the longest side of its box until a group is left. Runs on all
/// cores.
std::vector<std::uint32_t> order_in_groups(std::span<const MeasuringPoint> points);

}  // namespace kilolux
