// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>

#include "host/certify/shadow_scenarios.h"
#include "host/scene/lights/light_kinds.h"
#include "tests/support/render_fixture.h"

namespace kilolux {

/// The kinds of lights with a size.
inline constexpr auto kSizedTypes = [] {
    constexpr auto is_sized = [](const LightKind& kind) { return kind.shape != SHAPE_POINT; };
    std::array<LightType, std::ranges::count_if(kLightKinds, is_sized)> out{};
    std::size_t count = 0;
    for (const LightKind& kind : kLightKinds) {
        if (is_sized(kind)) out[count++] = kind.type;
    }
    return out;
}();

/// A light with a size above the floor of board_below(), of a kind that has one.
inline SceneLight panel(LightType type) {
    SceneLight light = lamp({0.0, 4.0, 0.0});
    light.type = type;
    light.direction = {0.0, -1.0, 0.0};
    light.side = glm::normalize(glm::dvec3(1.0, 0.0, 0.3));
    light.width = 2.0f;
    light.height = 1.2f;
    light.skew = 0.4f;
    light.radius = 0.7f;
    return light;
}

/// A board between a light and the floor. It lies askew, so that no quadrature aligns with it.
inline ShadowScenario board_below(const SceneLight& light) {
    Scene scene = shadow_stage();
    add_box(scene, {14.0, 0.5, 14.0}, {0.0, -0.25, 0.0});
    add_box(scene, {1.7, 0.02, 1.1}, {0.2, 1.3, 0.1}, 0.4);
    scene.lights.push_back(light);
    return {"board", scene, look_at({0.5, 3.5, 4.5}, {0.1, 0.0, 0.2}, {0, 1, 0}, 0.9)};
}

/// Sampled shadows of a scene's own lights on matt surfaces, and nothing else.
inline RenderSettings soft_settings(int width = 48, int height = 27, int rays = 4) {
    RenderSettings settings = small_settings(width, height, 0);
    settings.shadows = Shadows::sampled;
    settings.shadow_rays = rays;
    settings.shading = Shading::lambert;
    settings.ambient = 0.0f;
    return settings;
}

}  // namespace kilolux
