// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/material/material.h"

#include <algorithm>
#include <limits>

#include "host/scene/gltf/extensions.h"
#include "host/scene/gltf/material/specular_glossiness.h"

namespace kilolux {
namespace {

template <typename Info>
FileTextureUse use_of(const Info& info) {
    return {info.index, info.texCoord, &info.extensions};
}

float unit(double value) { return static_cast<float>(std::clamp(value, 0.0, 1.0)); }

constexpr double kMaxFloat = std::numeric_limits<float>::max();

float finite(double value) { return static_cast<float>(std::clamp(value, -kMaxFloat, kMaxFloat)); }

float positive(double value) { return finite(std::max(value, 0.0)); }

AlphaMode convert_alpha_mode(const std::string& mode) {
    if (mode == "MASK") return AlphaMode::mask;
    return mode == "BLEND" ? AlphaMode::blend : AlphaMode::opaque;
}

void read_specular(Material& out, const tinygltf::Value& specular, FileTextures& textures) {
    out.specular = unit(member_or(specular, "specularFactor", 1.0));
    const auto color = numbers_member(specular, "specularColorFactor");
    if (color.size() == 3) {
        out.specular_color = {positive(color[0]), positive(color[1]), positive(color[2])};
    }
    out.specular_texture = textures.convert(specular, "specularTexture");
    out.specular_color_texture = textures.convert(specular, "specularColorTexture");
}

void read_extensions(Material& out, const tinygltf::Material& source, FileTextures& textures) {
    if (const auto* strength =
            find_extension(source.extensions, "KHR_materials_emissive_strength")) {
        const double scale = member_or(*strength, "emissiveStrength", 1.0);
        for (glm::length_t c = 0; c < 3; ++c) out.emissive[c] = positive(out.emissive[c] * scale);
    }
    out.unlit = find_extension(source.extensions, "KHR_materials_unlit") != nullptr;
    if (is_specular_glossiness(source)) return;
    if (const auto* ior = find_extension(source.extensions, "KHR_materials_ior")) {
        // 0 means a Fresnel term of 1 (KHR_materials_ior); other values are at least vacuum's.
        const double value = member_or(*ior, "ior", 1.5);
        out.ior = value == 0.0 ? 0.0f : std::max(positive(value), 1.0f);
    }
    if (const auto* specular = find_extension(source.extensions, "KHR_materials_specular")) {
        read_specular(out, *specular, textures);
    }
}

void read_metallic_roughness(Material& out, const tinygltf::PbrMetallicRoughness& pbr,
                             FileTextures& textures) {
    for (glm::length_t c = 0; c < 4; ++c) {
        out.base_color[c] = unit(pbr.baseColorFactor[static_cast<std::size_t>(c)]);
    }
    out.base_color_texture = textures.convert(use_of(pbr.baseColorTexture));
    out.metallic = unit(pbr.metallicFactor);
    out.roughness = unit(pbr.roughnessFactor);
    out.metallic_roughness_texture = textures.convert(use_of(pbr.metallicRoughnessTexture));
}

Material convert_material(const tinygltf::Material& source, FileTextures& textures) {
    Material out;
    out.name = source.name;
    if (!is_specular_glossiness(source)) {
        read_metallic_roughness(out, source.pbrMetallicRoughness, textures);
    }
    out.normal_texture = textures.convert(use_of(source.normalTexture));
    out.normal_scale = finite(source.normalTexture.scale);
    out.occlusion_texture = textures.convert(use_of(source.occlusionTexture));
    out.occlusion_strength = unit(source.occlusionTexture.strength);
    for (glm::length_t c = 0; c < 3; ++c) {
        out.emissive[c] = unit(source.emissiveFactor[static_cast<std::size_t>(c)]);
    }
    out.emissive_texture = textures.convert(use_of(source.emissiveTexture));
    out.alpha_mode = convert_alpha_mode(source.alphaMode);
    out.alpha_cutoff = positive(source.alphaCutoff);
    out.double_sided = source.doubleSided;
    read_extensions(out, source, textures);
    return out;
}

// Renames the TEXCOORD_n that a material uses to 0 and 1 and returns their numbers. Textures of
// further sets are left out.
std::array<int, 2> pack_texcoord_sets(const GltfDocument& document, Material& material) {
    const std::array<TextureUse*, 7> uses = {
        &material.base_color_texture,    &material.metallic_roughness_texture,
        &material.normal_texture,        &material.occlusion_texture,
        &material.emissive_texture,      &material.specular_texture,
        &material.specular_color_texture};
    std::array<int, 2> sets = {0, 1};
    std::set<int> used;
    for (const TextureUse* use : uses) {
        if (use->present()) used.insert(use->uv_set);
    }
    if (used.empty() || *used.rbegin() <= 1) return sets;
    sets[0] = *used.begin();
    sets[1] = used.size() > 1 ? *std::next(used.begin()) : *used.begin();
    for (TextureUse* use : uses) {
        if (!use->present()) continue;
        if (use->uv_set != sets[0] && use->uv_set != sets[1]) {
            document.leave_out(
                fmt::format("material '{}' uses more than two sets of texture coordinates; its "
                            "textures of TEXCOORD_{} are left out",
                            shown_uri(material.name), use->uv_set));
            *use = {};
        } else {
            use->uv_set = use->uv_set == sets[0] ? 0 : 1;
        }
    }
    return sets;
}

}  // namespace

GltfMaterials convert_materials(const GltfDocument& document) {
    GltfMaterials out;
    FileTextures textures(document);
    for (const tinygltf::Material& source : document.model.materials) {
        out.materials.push_back(convert_material(source, textures));
    }
    out.textures = textures.textures();
    out.images = textures.images();
    convert_specular_glossiness(document, out);
    for (Material& material : out.materials) {
        out.texcoord_sets.push_back(pack_texcoord_sets(document, material));
    }
    add_line_materials(document, out);
    return out;
}

MeshShading shading_of(const GltfMaterials& materials, const tinygltf::Primitive& primitive) {
    MeshShading shading;
    const auto made = materials.of_lines.find(line_material_of(primitive));
    const bool is_made = corners_of(primitive) < 3 && made != materials.of_lines.end();
    shading.material = is_made ? made->second : primitive.material;
    if (shading.material < 0) return shading;
    const auto index = static_cast<std::size_t>(shading.material);
    shading.texcoord_sets = materials.texcoord_sets[index];
    shading.normal_texture = materials.materials[index].normal_texture;
    return shading;
}

}  // namespace kilolux
