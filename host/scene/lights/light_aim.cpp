// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/light_aim.h"

#include <cmath>
#include <glm/trigonometric.hpp>

namespace kilolux {
namespace {

// A direction, what is level at its right, and what is up from there.
struct AimAxes {
    glm::dvec3 forward, right, up;
};

AimAxes axes_of_aim(const LightAim& aim) {
    const double azimuth = glm::radians(aim.azimuth), elevation = glm::radians(aim.elevation);
    const glm::dvec3 level(std::sin(azimuth), 0.0, -std::cos(azimuth));
    const glm::dvec3 right(std::cos(azimuth), 0.0, std::sin(azimuth));
    const glm::dvec3 forward =
        std::cos(elevation) * level + glm::dvec3(0.0, std::sin(elevation), 0.0);
    return {forward, right, glm::cross(right, forward)};
}

}  // namespace

LightAim aim_of(const SceneLight& light) {
    // Below this sine the azimuth is rounding: files hold directions in float32.
    constexpr double kLeastSine = 1e-6;
    const glm::dvec3 forward = glm::normalize(light.direction);
    const double flat = std::hypot(forward.x, forward.z);
    LightAim out;
    if (flat > kLeastSine) out.azimuth = glm::degrees(std::atan2(forward.x, -forward.z));
    out.elevation = glm::degrees(std::atan2(forward.y, flat > kLeastSine ? flat : 0.0));
    const AimAxes axes = axes_of_aim(out);
    out.roll = glm::degrees(
        std::atan2(glm::dot(light.side, axes.up), glm::dot(light.side, axes.right)));
    return out;
}

void set_aim(SceneLight& light, const LightAim& aim) {
    const AimAxes axes = axes_of_aim(aim);
    const double roll = glm::radians(aim.roll);
    light.direction = axes.forward;
    light.side = std::cos(roll) * axes.right + std::sin(roll) * axes.up;
}

}  // namespace kilolux
