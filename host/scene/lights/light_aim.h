// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <glm/glm.hpp>

#include "host/scene/lights/light_kinds.h"

namespace kilolux {

/// Whether the light has a direction, by its kind or by a photometric web.
constexpr bool is_aimed_light(const SceneLight& light) {
    return kind_of(light).is_aimed || light.profile >= 0;
}

/// Whether its light depends on how it is turned about its direction.
constexpr bool has_roll(const SceneLight& light) {
    return kind_of(light).is_flat || light.profile >= 0;
}

/// Where a light that is_aimed_light() points, as angles [degrees].
struct LightAim {
    double azimuth = 0.0;    // the way that it shines, seen from above: 0 is -Z, 90 is +X
    double elevation = 0.0;  // of that way over the horizon, -90 to 90: 90 is +Y
    double roll = 0.0;       // 0: the side is level, to the right; 90: it points up
    bool operator==(const LightAim&) const = default;
};

/// Its direction, what is level at the right of it, and what is up from there.
struct AimAxes {
    glm::dvec3 forward, right, up;
};

inline AimAxes axes_of_aim(const LightAim& aim) {
    const double azimuth = glm::radians(aim.azimuth), elevation = glm::radians(aim.elevation);
    const glm::dvec3 level(std::sin(azimuth), 0.0, -std::cos(azimuth));
    const glm::dvec3 right(std::cos(azimuth), 0.0, std::sin(azimuth));
    const glm::dvec3 forward =
        std::cos(elevation) * level + glm::dvec3(0.0, std::sin(elevation), 0.0);
    return {forward, right, glm::cross(right, forward)};
}

/// The aim of a light with a direction; azimuth and roll from -180 to 180. Straight up and down
/// the azimuth is 0, and the roll tells how the light is turned.
inline LightAim aim_of(const SceneLight& light) {
    // Below this sine the azimuth is rounding: files hold directions in float32.
    constexpr double kLeastSine = 1e-6;
    const glm::dvec3 forward = glm::normalize(light.direction);
    const double flat = std::hypot(forward.x, forward.z);
    LightAim out;
    if (flat > kLeastSine) out.azimuth = glm::degrees(std::atan2(forward.x, -forward.z));
    out.elevation = glm::degrees(std::atan2(forward.y, flat > kLeastSine ? flat : 0.0));
    const AimAxes axes = axes_of_aim(out);
    out.roll =
        glm::degrees(std::atan2(glm::dot(light.side, axes.up), glm::dot(light.side, axes.right)));
    return out;
}

/// Gives the light this direction and side, both unit.
inline void set_aim(SceneLight& light, const LightAim& aim) {
    const AimAxes axes = axes_of_aim(aim);
    const double roll = glm::radians(aim.roll);
    light.direction = axes.forward;
    light.side = std::cos(roll) * axes.right + std::sin(roll) * axes.up;
}

}  // namespace kilolux
