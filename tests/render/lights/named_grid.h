// SPDX-License-Identifier: Apache-2.0
// A scene whose lights are in groups, and the settings of groups.
#pragma once

#include <algorithm>

#include "host/base/error.h"
#include "host/picture/aovs.h"
#include "host/scene/lights/light_kinds.h"
#include "host/scene/lights/light_mix.h"
#include "tests/support/render_fixture.h"

namespace kilolux {

/// grid_with_every_light() and the swarm, whose spots have names, in a light that is no light's.
inline Scene named_grid() {
    Scene scene = grid_with_every_light();
    scene.light_nodes = {{"left", ""}, {"right", "lamps"}};
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        SceneLight& light = scene.lights[i];
        if (kind_of(light).has_cone) light.node = i % 2 == 0 ? 0 : 1;
    }
    return scene;
}

inline constexpr const char* kGroups =
    "left=left,right=group:lamp*,sun=kind:directional,swarm=from:generated+kind:sphere";

/// With a layer for each group.
inline RenderSettings grouped(const Scene& scene, RenderSettings settings,
                              const char* groups = kGroups) {
    settings.light_groups =
        light_groups_of(scene, settings.lights, parse_light_groups("--light-groups", groups));
    return settings;
}

/// With gains of the groups, without layers.
inline RenderSettings mixed(const Scene& scene, RenderSettings settings, const char* gains,
                            const char* groups = kGroups) {
    settings.light_mix = {parse_light_mix("--light-mix", gains),
                          grouped(scene, settings, groups).light_groups};
    check_light_mix(settings.light_mix);
    return settings;
}

inline const Layer& layer_of(const Frame& frame, const std::string& group) {
    const auto found =
        std::ranges::find(frame.aovs, std::string(kLightLayers) + group, &Layer::name);
    if (found == frame.aovs.end()) throw Error("no layer " + group);
    return *found;
}

}  // namespace kilolux
