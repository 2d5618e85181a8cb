// SPDX-License-Identifier: Apache-2.0
#include "host/base/scene_features.h"

#include <charconv>

namespace kilolux {
namespace {

using F = SceneFeatures;

constexpr SceneFeature kTable[] = {
    {"point-lights", &F::point_lights},
    {"spot-lights", &F::spot_lights, "HAS_SPOT_LIGHTS", true},
    {"light-profiles", &F::light_profiles, "HAS_LIGHT_PROFILES"},
    {"directional-lights", &F::directional_lights, "HAS_DIRECTIONAL_LIGHTS", true},
    {"area-lights", &F::area_lights, "HAS_AREA_LIGHTS"},
    {"metallic", &F::metallic, "HAS_METALLIC", true},
    {"emissive", &F::emissive, nullptr, true},
    {"", &F::material, "HAS_MATERIAL"},
    {"occlusion", &F::occlusion, "HAS_OCCLUSION", true},
    {"specular", &F::specular, "HAS_SPECULAR", true},
    {"clearcoat", &F::clearcoat, "HAS_CLEARCOAT", true},
    {"coat-normals", &F::coat_normals, "HAS_COAT_NORMAL", true},
    {"sheen", &F::sheen, "HAS_SHEEN", true},
    {"anisotropy", &F::anisotropy, "HAS_ANISOTROPY", true},
    {"transmission", &F::transmission, "HAS_TRANSMISSION"},
    {"unlit", &F::unlit_materials, nullptr, true},
    {"", &F::unlit, "HAS_UNLIT"},
    {"", &F::gloss},
    {"normal-maps", &F::normal_maps},
    {"alpha-mask", &F::alpha_mask},
    {"alpha-blend", &F::alpha_blend},
    {"wide-light-index", &F::wide_light_index, nullptr, true},
    {"shadows", &F::shadows},
    {"", &F::illuminance, "ILLUMINANCE"},
};

// The shortest text that is read back as the same float.
std::string literal(float value) {
    char digits[32];
    const char* end =
        std::to_chars(digits, digits + sizeof(digits), value, std::chars_format::scientific).ptr;
    return std::string(static_cast<const char*>(digits), end) + "f";
}

}  // namespace

std::span<const SceneFeature> scene_feature_table() { return kTable; }

std::vector<std::pair<std::string, std::string>> feature_macros(const SceneFeatures& features) {
    std::vector<std::pair<std::string, std::string>> macros;
    for (const SceneFeature& feature : kTable) {
        if (feature.macro) macros.emplace_back(feature.macro, features.*feature.member ? "1" : "0");
    }
    if (features.light_d_min != LIGHT_D_MIN) {
        macros.emplace_back("LIGHT_D_MIN", literal(features.light_d_min));
    }
    if (features.light_groups > 0) {
        macros.emplace_back("LIGHT_GROUPS", std::to_string(features.light_groups));
    }
    const bool has_random_ranges = features.random_ranges > 0.0f;
    macros.emplace_back("HAS_RANDOM_RANGES", has_random_ranges ? "1" : "0");
    if (has_random_ranges) macros.emplace_back("RANDOM_RANGES", literal(features.random_ranges));
    return macros;
}

}  // namespace kilolux
