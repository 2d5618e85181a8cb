// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <type_traits>
#include <variant>

#include "host/scene/scene.h"
#include "kernels/shared/material.h"

namespace kilolux {

/// A texture of a material. The loader, its rules, the rows for devices, the exporter and the
/// references loop over these.
struct MaterialMap {
    int use;                // its number on devices, USE_*
    std::string_view path;  // in a glTF material
    TextureUse Material::*member;
    bool srgb;                  // its colours are stored as sRGB
    std::string_view channels;  // that are read
};

inline constexpr std::array<MaterialMap, USE_COUNT> kMaterialMaps = {{
    {USE_BASE_COLOR, "pbrMetallicRoughness.baseColorTexture", &Material::base_color_texture, true,
     "rgba"},
    {USE_METALLIC_ROUGHNESS, "pbrMetallicRoughness.metallicRoughnessTexture",
     &Material::metallic_roughness_texture, false, "gb"},
    {USE_NORMAL, "normalTexture", &Material::normal_texture, false, "rgb"},
    {USE_OCCLUSION, "occlusionTexture", &Material::occlusion_texture, false, "r"},
    {USE_EMISSIVE, "emissiveTexture", &Material::emissive_texture, true, "rgb"},
    {USE_SPECULAR, "extensions.KHR_materials_specular.specularTexture", &Material::specular_texture,
     false, "a"},
    {USE_SPECULAR_COLOR, "extensions.KHR_materials_specular.specularColorTexture",
     &Material::specular_color_texture, true, "rgb"},
}};

static_assert([] {
    for (int use = 0; use < USE_COUNT; ++use) {
        if (kMaterialMaps[static_cast<std::size_t>(use)].use != use) return false;
    }
    return true;
}());

/// The range to which a file's factor is clamped.
enum class FactorRange { unit, positive, finite, ior };

/// A number or colour of a material that is stored here as in glTF.
struct MaterialFactor {
    std::string_view path;  // in a glTF material
    std::variant<float Material::*, glm::vec3 Material::*, glm::vec4 Material::*> member;
    FactorRange range = FactorRange::unit;
};

/// Read before KHR_materials_emissive_strength, which multiplies emissiveFactor.
inline constexpr std::array kMaterialFactors = {
    MaterialFactor{"pbrMetallicRoughness.baseColorFactor", &Material::base_color},
    MaterialFactor{"pbrMetallicRoughness.metallicFactor", &Material::metallic},
    MaterialFactor{"pbrMetallicRoughness.roughnessFactor", &Material::roughness},
    MaterialFactor{"normalTexture.scale", &Material::normal_scale, FactorRange::finite},
    MaterialFactor{"occlusionTexture.strength", &Material::occlusion_strength},
    MaterialFactor{"emissiveFactor", &Material::emissive},
    MaterialFactor{"alphaCutoff", &Material::alpha_cutoff, FactorRange::positive},
    MaterialFactor{"extensions.KHR_materials_ior.ior", &Material::ior, FactorRange::ior},
    MaterialFactor{"extensions.KHR_materials_specular.specularFactor", &Material::specular},
    MaterialFactor{"extensions.KHR_materials_specular.specularColorFactor",
                   &Material::specular_color, FactorRange::positive},
};

/// Numbers of a factor: 1, 3 or 4.
constexpr std::size_t factor_length(const MaterialFactor& factor) {
    constexpr std::array<std::size_t, 3> kLengths = {1, 3, 4};
    return kLengths[factor.member.index()];
}

/// A factor's numbers in a material.
template <typename M>
auto factor_values(M& material, const MaterialFactor& factor) {
    return std::visit(
        [&](auto member) {
            auto& value = material.*member;
            if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, float>) {
                return std::span(&value, 1);
            } else {
                return std::span(&value.x, static_cast<std::size_t>(value.length()));
            }
        },
        factor.member);
}

}  // namespace kilolux
