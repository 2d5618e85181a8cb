// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "host/base/scene_features.h"
#include "host/scene/scene.h"

namespace kilolux {

/// Extensions of glTF that have lights: an array of "lights", of which a node names one. The
/// loader, its rules and the exporter loop over these.
inline constexpr std::string_view kPunctual = "KHR_lights_punctual";
inline constexpr std::array kLightExtensions = {kPunctual};

/// Properties of a kind of light. The loader, its rules, the exporter and ranges read these rows
/// instead of naming kinds.
struct LightKind {
    LightType type;
    std::string_view extension;  // of kLightExtensions
    std::string_view name;       // there and in Python
    bool is_placed;              // has a position and a range, intensity in candela; else lux
    bool is_aimed;               // has a direction
    bool has_cone;
    bool is_summed;  // a light tree may replace many by one: a point, equal in all directions
    bool SceneFeatures::*feature;  // of scenes that have one
};

inline constexpr auto kLightKinds = std::to_array<LightKind>({
    {LightType::point, kPunctual, "point", true, false, false, true, &SceneFeatures::point_lights},
    {LightType::spot, kPunctual, "spot", true, true, true, false, &SceneFeatures::spot_lights},
    {LightType::directional, kPunctual, "directional", false, true, false, false,
     &SceneFeatures::directional_lights},
});
static_assert([] {
    for (const LightKind& kind : kLightKinds) {
        if (&kind != &kLightKinds[static_cast<std::size_t>(kind.type)]) return false;
        if (kind.is_summed && (!kind.is_placed || kind.is_aimed)) return false;
    }
    return true;
}());  // for kind_of()

/// A number that some kinds of light have, in a file as here; 0 is a file's default. The loader,
/// its rules, the exporter, Python and the test of a light's usability loop over these.
struct LightNumber {
    std::string_view path;  // in a light of a file
    const char* name;       // in Python
    float SceneLight::*member;
    bool LightKind::*has;      // the kinds that have it
    bool is_positive = false;  // a light of 0 or less gives none
};

inline constexpr auto kLightNumbers = std::to_array<LightNumber>({
    {"range", "range", &SceneLight::range, &LightKind::is_placed, true},
    {"spot.innerConeAngle", "inner_cone", &SceneLight::inner_cone, &LightKind::has_cone},
    {"spot.outerConeAngle", "outer_cone", &SceneLight::outer_cone, &LightKind::has_cone, true},
});

constexpr const LightKind& kind_of(LightType type) {
    return kLightKinds[static_cast<std::size_t>(type)];
}
constexpr const LightKind& kind_of(const SceneLight& light) { return kind_of(light.type); }

/// Adds what a scene needs that has the light.
inline void add_features(SceneFeatures& features, const SceneLight& light) {
    features.*kind_of(light).feature = true;
}

/// Null for a name that the extension does not have.
constexpr const LightKind* find_light_kind(std::string_view extension, std::string_view name) {
    const auto found = std::ranges::find_if(kLightKinds, [&](const LightKind& kind) {
        return kind.extension == extension && kind.name == name;
    });
    return found == kLightKinds.end() ? nullptr : &*found;
}

/// Whether some kind of the extension has the number.
constexpr bool has_number(std::string_view extension, const LightNumber& number) {
    return std::ranges::any_of(kLightKinds, [&](const LightKind& kind) {
        return kind.extension == extension && kind.*number.has;
    });
}

inline bool is_finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Whether the numbers of the light's kind are finite, and positive where they must be.
inline bool has_good_numbers(const SceneLight& light) {
    return std::ranges::all_of(kLightNumbers, [&](const LightNumber& number) {
        const float value = light.*number.member;
        return !(kind_of(light).*number.has) ||
               (std::isfinite(value) && (!number.is_positive || value > 0.0f));
    });
}

/// Says what KHR_lights_punctual does not allow of a light's cone; empty where it allows it.
inline std::string cone_problem(const SceneLight& light) {
    constexpr float kWidest = 1.5708f;  // [rad], a quarter turn, rounded up
    const float inner = light.inner_cone, outer = light.outer_cone;
    if (!kind_of(light).has_cone || (0.0f <= inner && inner < outer && outer <= kWidest)) return "";
    return fmt::format("inner cone {}, outer cone {}: must be 0 <= inner < outer <= pi / 2", inner,
                       outer);
}

}  // namespace kilolux
