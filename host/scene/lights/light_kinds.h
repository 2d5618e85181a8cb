// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "host/scene/scene.h"

namespace kilolux {

/// Properties of a kind of light. The loader, its rules, the exporter, ranges and the Python module
/// read these rows instead of naming kinds.
struct LightKind {
    LightType type;
    std::string_view name;  // in KHR_lights_punctual and in Python
    bool is_placed;         // has a position and a range, intensity in candela; else lux
    bool is_aimed;          // has a direction
    bool has_cone;
};

inline constexpr std::array kLightKinds = {
    LightKind{LightType::point, "point", true, false, false},
    LightKind{LightType::spot, "spot", true, true, true},
    LightKind{LightType::directional, "directional", false, true, false},
};

constexpr const LightKind& kind_of(LightType type) {
    return *std::ranges::find(kLightKinds, type, &LightKind::type);
}
constexpr const LightKind& kind_of(const SceneLight& light) { return kind_of(light.type); }

/// Null for an unknown name.
constexpr const LightKind* find_light_kind(std::string_view name) {
    const auto found = std::ranges::find(kLightKinds, name, &LightKind::name);
    return found == kLightKinds.end() ? nullptr : &*found;
}

}  // namespace kilolux
