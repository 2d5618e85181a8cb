// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/rig.h"

namespace kilolux {
namespace {

constexpr double kHeadlight = 2.2;  // [lx]

SceneLight directional(const glm::dvec3& towards_light, const glm::dvec3& illuminance) {
    SceneLight light;
    light.type = LightType::directional;
    light.direction = -glm::normalize(towards_light);
    light.intensity = glm::vec3(illuminance);
    return light;
}

std::vector<SceneLight> studio() {
    return {directional({-0.8, 1.0, 1.2}, {2.0, 1.9, 1.75}),    // key, a little warm
            directional({1.2, 0.25, 0.9}, {0.55, 0.6, 0.65}),   // fill, a little cool
            directional({0.5, 0.9, -1.2}, {1.3, 1.35, 1.4}),    // rim
            directional({-0.1, 1.0, 0.1}, {0.6, 0.6, 0.6}),     // from above
            directional({-0.9, -0.6, -0.3}, {0.3, 0.3, 0.3})};  // from the floor
}

SceneLight headlight() {
    SceneLight light = directional({0, 0, 1}, glm::dvec3(kHeadlight));
    light.follows_camera = true;
    return light;
}

}  // namespace

Rig automatic_rig(const Scene& scene, bool is_generated) {
    if (is_generated) return Rig::swarm;
    if (!scene.lights.empty()) return Rig::none;
    return scene.kind == SceneKind::interior ? Rig::swarm : Rig::studio;
}

std::vector<SceneLight> rig_lights(Rig rig) {
    if (rig == Rig::studio) return studio();
    if (rig == Rig::headlight) return {headlight()};
    return {};
}

float rig_ambient(Rig rig, float standard) {
    constexpr float kSurroundRadiance = 0.2f;
    return rig == Rig::studio ? kSurroundRadiance : standard;
}

SceneLight placed_light(SceneLight light, const glm::dmat3& world_from_view,
                        const glm::dvec3& camera_position) {
    if (!light.follows_camera) return light;
    light.position = camera_position + world_from_view * light.position;
    light.direction = world_from_view * light.direction;
    light.follows_camera = false;
    return light;
}

}  // namespace kilolux
