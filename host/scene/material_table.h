// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <type_traits>
#include <variant>

#include "host/base/scene_features.h"
#include "host/scene/scene.h"
#include "kernels/shared/material.h"

namespace kilolux {

/// A texture of a material. The loader, its rules, the rows for devices, the exporter and the
/// references loop over these. A path "extensions.NAME..." says that the extension NAME is read.
struct MaterialMap {
    int use;                // its number on devices, USE_*
    std::string_view path;  // in a glTF material
    TextureUse Material::*member;
    bool srgb;                              // its colours are stored as sRGB
    std::string_view channels;              // that are read
    bool SceneFeatures::*needed = nullptr;  // scenes without this do not keep it; null: all keep it
};

inline constexpr std::array<MaterialMap, USE_COUNT> kMaterialMaps = {{
    {USE_BASE_COLOR, "pbrMetallicRoughness.baseColorTexture", &Material::base_color_texture, true,
     "rgba"},
    {USE_METALLIC_ROUGHNESS, "pbrMetallicRoughness.metallicRoughnessTexture",
     &Material::metallic_roughness_texture, false, "gb", &SceneFeatures::gloss},
    {USE_NORMAL, "normalTexture", &Material::normal_texture, false, "rgb"},
    {USE_OCCLUSION, "occlusionTexture", &Material::occlusion_texture, false, "r",
     &SceneFeatures::occlusion},
    {USE_EMISSIVE, "emissiveTexture", &Material::emissive_texture, true, "rgb",
     &SceneFeatures::material},
    {USE_SPECULAR, "extensions.KHR_materials_specular.specularTexture", &Material::specular_texture,
     false, "a", &SceneFeatures::specular},
    {USE_SPECULAR_COLOR, "extensions.KHR_materials_specular.specularColorTexture",
     &Material::specular_color_texture, true, "rgb", &SceneFeatures::specular},
    {USE_CLEARCOAT, "extensions.KHR_materials_clearcoat.clearcoatTexture",
     &Material::clearcoat_texture, false, "r", &SceneFeatures::clearcoat},
    {USE_CLEARCOAT_ROUGHNESS, "extensions.KHR_materials_clearcoat.clearcoatRoughnessTexture",
     &Material::clearcoat_roughness_texture, false, "g", &SceneFeatures::clearcoat},
    {USE_CLEARCOAT_NORMAL, "extensions.KHR_materials_clearcoat.clearcoatNormalTexture",
     &Material::clearcoat_normal_texture, false, "rgb", &SceneFeatures::coat_normals},
    {USE_SHEEN_COLOR, "extensions.KHR_materials_sheen.sheenColorTexture",
     &Material::sheen_color_texture, true, "rgb", &SceneFeatures::sheen},
    {USE_SHEEN_ROUGHNESS, "extensions.KHR_materials_sheen.sheenRoughnessTexture",
     &Material::sheen_roughness_texture, false, "a", &SceneFeatures::sheen},
    {USE_ANISOTROPY, "extensions.KHR_materials_anisotropy.anisotropyTexture",
     &Material::anisotropy_texture, false, "rgb", &SceneFeatures::anisotropy},
    {USE_TRANSMISSION, "extensions.KHR_materials_transmission.transmissionTexture",
     &Material::transmission_texture, false, "r", &SceneFeatures::transmission},
    {USE_THICKNESS, "extensions.KHR_materials_volume.thicknessTexture",
     &Material::thickness_texture, false, "g", &SceneFeatures::transmission},
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
    float4 MaterialRow::*row;  // where devices read it; null: material_row() computes from it
    int component;             // of the row, the first one
    FactorRange range = FactorRange::unit;
};

/// Read before KHR_materials_emissive_strength, which multiplies emissiveFactor.
inline constexpr auto kMaterialFactors = std::to_array<MaterialFactor>({
    {"pbrMetallicRoughness.baseColorFactor", &Material::base_color, &MaterialRow::base_color, 0},
    {"pbrMetallicRoughness.metallicFactor", &Material::metallic, &MaterialRow::factors, 0},
    {"pbrMetallicRoughness.roughnessFactor", &Material::roughness, &MaterialRow::factors, 1},
    {"normalTexture.scale", &Material::normal_scale, &MaterialRow::factors, 2, FactorRange::finite},
    {"occlusionTexture.strength", &Material::occlusion_strength, &MaterialRow::factors, 3},
    {"emissiveFactor", &Material::emissive, &MaterialRow::emissive_cutoff, 0},
    {"alphaCutoff", &Material::alpha_cutoff, &MaterialRow::emissive_cutoff, 3,
     FactorRange::positive},
    {"extensions.KHR_materials_ior.ior", &Material::ior, nullptr, 0, FactorRange::ior},
    {"extensions.KHR_materials_specular.specularFactor", &Material::specular,
     &MaterialRow::specular, 3},
    {"extensions.KHR_materials_specular.specularColorFactor", &Material::specular_color, nullptr, 0,
     FactorRange::positive},
    {"extensions.KHR_materials_clearcoat.clearcoatFactor", &Material::clearcoat,
     &MaterialRow::clearcoat, 0},
    {"extensions.KHR_materials_clearcoat.clearcoatRoughnessFactor", &Material::clearcoat_roughness,
     &MaterialRow::clearcoat, 1},
    {"extensions.KHR_materials_clearcoat.clearcoatNormalTexture.scale",
     &Material::clearcoat_normal_scale, &MaterialRow::clearcoat, 2, FactorRange::finite},
    {"extensions.KHR_materials_sheen.sheenColorFactor", &Material::sheen_color, &MaterialRow::sheen,
     0},
    {"extensions.KHR_materials_sheen.sheenRoughnessFactor", &Material::sheen_roughness,
     &MaterialRow::sheen, 3},
    {"extensions.KHR_materials_anisotropy.anisotropyStrength", &Material::anisotropy_strength,
     &MaterialRow::anisotropy, 0},
    {"extensions.KHR_materials_anisotropy.anisotropyRotation", &Material::anisotropy_rotation,
     nullptr, 0, FactorRange::finite},
    {"extensions.KHR_materials_transmission.transmissionFactor", &Material::transmission,
     &MaterialRow::transmission, 0},
    {"extensions.KHR_materials_volume.thicknessFactor", &Material::thickness, &MaterialRow::volume,
     3, FactorRange::positive},
    {"extensions.KHR_materials_volume.attenuationDistance", &Material::attenuation_distance,
     nullptr, 0, FactorRange::positive},
    {"extensions.KHR_materials_volume.attenuationColor", &Material::attenuation_color, nullptr, 0},
});

/// The map by whose texture coordinates tangents are made: the first one in tangent space, or the
/// first set of coordinates where there is none.
inline const TextureUse& tangent_map(const Material& material) {
    for (const MaterialMap& map : kMaterialMaps) {
        const TextureUse& use = material.*map.member;
        if ((TANGENT_USES & (1u << map.use)) != 0 && use.present()) return use;
    }
    return material.normal_texture;
}

inline bool needs_tangents(const Material& material) { return tangent_map(material).present(); }

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

/// An extension of materials that is left out.
struct LeftOutExtension {
    std::string_view name;
    std::string_view lacks;  // how the picture shows it
};

inline constexpr auto kLeftOutMaterialExtensions = std::to_array<LeftOutExtension>({
    {"KHR_materials_volume_scatter", "no light scatters below surfaces"},
    {"KHR_materials_diffuse_transmission", "leaves and paper let no light through"},
    {"KHR_materials_dispersion", "glass shows no rainbow"},
    {"KHR_materials_iridescence", "thin films show no colours"},
});

}  // namespace kilolux
