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
#include "kernels/shared/area/area_shape.h"

namespace kilolux {

/// Extensions of glTF that have lights: an array of "lights", of which a node names one. The
/// loader, its rules and the exporter loop over these.
inline constexpr std::string_view kPunctual = "KHR_lights_punctual";
inline constexpr std::string_view kArea = "EXT_lights_area";
inline constexpr std::array kLightExtensions = {kPunctual, kArea};
/// Its lights are photometric webs, apart from these.
inline constexpr const char* kPhotometric = "EXT_lights_ies";

/// The intensity of a light whose file has none: [cd], [lx], of area lights [nit].
constexpr double default_intensity(std::string_view extension) {
    return extension == kArea ? 1000.0 : 1.0;
}

/// Properties of a kind of light. The loader, its rules, the exporter and ranges read these rows
/// instead of naming kinds.
struct LightKind {
    LightType type;
    std::string_view name;              // in Python
    std::string_view extension{};       // of kLightExtensions; empty: no file has it
    std::string_view name_in_file{};    // a sphere is a point with a radius
    std::string_view aspect_in_file{};  // its width / height
    uint shape = SHAPE_POINT;           // SHAPE_*: else it has a size
    bool is_placed = true;  // has a position and a range, intensity in candela; else lux
    bool is_aimed = false;  // has a direction
    bool is_flat = false;   // has a width and a height, and may be two-sided
    bool has_cone = false;
    bool has_skew = false;
    bool has_radius = false;
    bool is_summed =
        false;  // a light tree may replace many by one: a point, equal in all directions
    bool SceneFeatures::*feature = &SceneFeatures::area_lights;  // of scenes that have one
};

inline constexpr auto kLightKinds = std::to_array<LightKind>({
    {.type = LightType::point,
     .name = "point",
     .extension = kPunctual,
     .name_in_file = "point",
     .is_summed = true,
     .feature = &SceneFeatures::point_lights},
    {.type = LightType::spot,
     .name = "spot",
     .extension = kPunctual,
     .name_in_file = "spot",
     .is_aimed = true,
     .has_cone = true,
     .feature = &SceneFeatures::spot_lights},
    {.type = LightType::directional,
     .name = "directional",
     .extension = kPunctual,
     .name_in_file = "directional",
     .is_placed = false,
     .is_aimed = true,
     .feature = &SceneFeatures::directional_lights},
    {.type = LightType::rectangle,
     .name = "rect",
     .extension = kArea,
     .name_in_file = "rect",
     .aspect_in_file = "rect.aspect",
     .shape = SHAPE_RECTANGLE,
     .is_aimed = true,
     .is_flat = true},
    {.type = LightType::disk,
     .name = "disk",
     .extension = kArea,
     .name_in_file = "disk",
     .aspect_in_file = "extras.aspect",
     .shape = SHAPE_DISK,
     .is_aimed = true,
     .is_flat = true},
    {.type = LightType::sphere,
     .name = "sphere",
     .extension = kPunctual,
     .name_in_file = "point",
     .shape = SHAPE_SPHERE,
     .has_radius = true},
    {.type = LightType::triangle,
     .name = "triangle",
     .shape = SHAPE_TRIANGLE,
     .is_aimed = true,
     .is_flat = true,
     .has_skew = true},
});
static_assert([] {
    for (const LightKind& kind : kLightKinds) {
        if (&kind != &kLightKinds[static_cast<std::size_t>(kind.type)]) return false;
        if (kind.is_summed && (!kind.is_placed || kind.is_aimed || kind.shape != SHAPE_POINT)) {
            return false;
        }
    }
    return true;
}());  // for kind_of()

/// A number that some kinds of light have, in a file as here; 0 is a file's default. The loader,
/// its rules, the exporter, Python and the test of a light's usability loop over these.
struct LightNumber {
    const char* name;  // in Python
    float SceneLight::*member;
    bool LightKind::*has;  // the kinds that have it
    // In a light of a file, by kLightExtensions; empty: read otherwise, or not there. What an
    // extension lacks is among the extras.
    std::array<std::string_view, kLightExtensions.size()> paths{};
    bool is_positive = false;  // a light of 0 or less gives none
    bool is_angle = false;     // [rad], else [m]
};

inline constexpr auto kLightNumbers = std::to_array<LightNumber>({
    {"range", &SceneLight::range, &LightKind::is_placed, {"range", "extras.range"}, true},
    {"inner_cone",
     &SceneLight::inner_cone,
     &LightKind::has_cone,
     {"spot.innerConeAngle"},
     false,
     true},
    {"outer_cone",
     &SceneLight::outer_cone,
     &LightKind::has_cone,
     {"spot.outerConeAngle"},
     true,
     true},
    {"height", &SceneLight::height, &LightKind::is_flat, {"", "size"}, true},
    {"width", &SceneLight::width, &LightKind::is_flat, {}, true},
    {"skew", &SceneLight::skew, &LightKind::has_skew},
    {"radius", &SceneLight::radius, &LightKind::has_radius, {"extras.radius"}, true},
});
inline constexpr std::string_view kTwoSided = "extras.twoSided";  // of flat lights in a file
inline constexpr std::string_view kExtrasGroup = "extras.group";  // a text: see light_groups.h

/// Properties that applications define: files may have them with another meaning.
constexpr bool is_extra(std::string_view path) { return path.starts_with("extras."); }

constexpr const LightKind& kind_of(LightType type) {
    return kLightKinds[static_cast<std::size_t>(type)];
}
constexpr const LightKind& kind_of(const SceneLight& light) { return kind_of(light.type); }

/// Whether the light has a size.
constexpr bool is_area_light(const SceneLight& light) {
    return kind_of(light).shape != SHAPE_POINT;
}

/// Adds what a scene needs that has the light.
inline void add_features(SceneFeatures& features, const SceneLight& light) {
    const LightKind& kind = kind_of(light);
    features.*kind.feature = true;
    // Lists test the half-space before a one-sided light as a cone.
    features.spot_lights |= kind.is_flat && !light.two_sided;
}

/// The kind of a light of a file, with a radius or without one; null for a name that the extension
/// does not have, or only without a radius.
constexpr const LightKind* find_light_kind(std::string_view extension, std::string_view name,
                                           bool has_radius = false) {
    const auto found = std::ranges::find_if(kLightKinds, [&](const LightKind& kind) {
        return kind.extension == extension && kind.name_in_file == name &&
               kind.has_radius == has_radius;
    });
    return found == kLightKinds.end() ? nullptr : &*found;
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

/// Says which of the light's sizes is not above 0; empty without one.
inline std::string size_problem(const SceneLight& light) {
    for (const LightNumber& number : kLightNumbers) {
        const bool is_size =
            number.has == &LightKind::is_flat || number.has == &LightKind::has_radius;
        const float value = light.*number.member;
        if (!is_size || !(kind_of(light).*number.has) || value > 0.0f) continue;
        return fmt::format("{} is {}, must be above 0", number.name, value);
    }
    return "";
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
