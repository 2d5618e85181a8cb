// SPDX-License-Identifier: Apache-2.0
#include "raster/material_features.h"

#include <fmt/format.h>
#include <array>

namespace kilolux {
namespace {

constexpr std::array<const char*, USE_COUNT> kUvNames = {
    "BASE_COLOR_UV", "METALLIC_ROUGHNESS_UV", "NORMAL_UV",        "OCCLUSION_UV",
    "EMISSIVE_UV",   "SPECULAR_UV",           "SPECULAR_COLOR_UV"};

bool same_lookup(const TextureUse& a, const TextureUse& b) {
    return a.texture == b.texture && a.uv_set == b.uv_set &&
           a.uv_from_texcoord == b.uv_from_texcoord;
}

// GLSL that gives the coordinates with which a use's texture is read.
std::string uv_expression(uint features, int use) {
    std::string texcoord =
        (features & (kFeatureTexcoord1 << use)) != 0 ? "v_texcoord1" : "v_texcoord0";
    if ((features & (kFeatureTransform << use)) == 0) return texcoord;
    return fmt::format("transformed({}, {})", use, texcoord);
}

}  // namespace

uint features_of(const Mesh& mesh, const Material& material) {
    uint features = 0;
    for (int use = 0; use < USE_COUNT; ++use) {
        const TextureUse& texture = texture_use(material, use);
        if (!texture.present()) continue;
        features |= kFeatureTexture << use;
        if (texture.uv_set == 1) features |= kFeatureTexcoord1 << use;
        if (texture.uv_from_texcoord != glm::mat3(1.0f)) features |= kFeatureTransform << use;
    }
    if (mesh.tangents.empty()) features = without_texture(features, USE_NORMAL);
    if (!mesh.colors.empty()) features |= kFeatureVertexColor;
    if (material.alpha_mode == AlphaMode::mask) features |= kFeatureAlphaMask;
    if (material.double_sided) features |= kFeatureDoubleSided;
    if (material.unlit) features |= kFeatureUnlit;
    if (material.occlusion_texture.present() &&
        same_lookup(material.occlusion_texture, material.metallic_roughness_texture)) {
        features |= kFeatureSharedOcclusion;
    }
    return features;
}

uint without_texture(uint features, int use) {
    uint off = (kFeatureTexture | kFeatureTexcoord1 | kFeatureTransform) << use;
    if (use == USE_OCCLUSION || use == USE_METALLIC_ROUGHNESS) off |= kFeatureSharedOcclusion;
    return features & ~off;
}

uint coverage_features() {
    constexpr uint kBaseColor = (kFeatureTexture | kFeatureTexcoord1 | kFeatureTransform)
                                << USE_BASE_COLOR;
    return kFeatureAlphaMask | kFeatureVertexColor | kBaseColor;
}

Defines feature_defines(uint features, const PassInputs& inputs) {
    Defines defines;
    bool texcoord[2] = {false, false};
    for (int use = 0; use < USE_COUNT; ++use) {
        std::optional<std::string> uv;
        if ((features & (kFeatureTexture << use)) != 0) {
            uv = uv_expression(features, use);
            texcoord[(features & (kFeatureTexcoord1 << use)) != 0 ? 1 : 0] = true;
        }
        define_optional(defines, kUvNames[static_cast<std::size_t>(use)], uv);
    }
    const auto define = [&](bool wanted, const char* name) {
        defines.emplace_back(name, wanted ? "1" : "0");
    };
    define(inputs.surface, "SURFACE");
    define(inputs.position, "POSITION");
    define(inputs.ids, "IDS");
    define(texcoord[0], "TEXCOORD0");
    define(texcoord[1], "TEXCOORD1");
    define((features & (kFeatureTexture << USE_NORMAL)) != 0, "TANGENT");
    define((features & kFeatureVertexColor) != 0, "VERTEX_COLOR");
    define((features & kFeatureAlphaMask) != 0, "ALPHA_MASK");
    define((features & kFeatureDoubleSided) != 0, "DOUBLE_SIDED");
    define((features & kFeatureUnlit) != 0, "UNLIT");
    define((features & kFeatureSharedOcclusion) != 0, "OCCLUSION_SHARES_METALLIC_ROUGHNESS");
    return defines;
}

}  // namespace kilolux
