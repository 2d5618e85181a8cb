// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/material/specular_glossiness.h"

#include <algorithm>

namespace kilolux {
namespace {

using nlohmann::json;

constexpr const char* kGlossinessExtension = "extensions.KHR_materials_pbrSpecularGlossiness";

float share(double value) { return static_cast<float>(std::clamp(value, 0.0, 1.0)); }

double glossiness_of(const json& extension) {
    return std::clamp(extension.value("glossinessFactor", 1.0), 0.0, 1.0);
}

}  // namespace

bool is_specular_glossiness(const json& material) {
    return find_member(material, kGlossinessExtension) != nullptr;
}

void read_specular_glossiness(Material& out, const json& source, FileTextures& textures) {
    const json& extension = *find_member(source, kGlossinessExtension);
    const auto diffuse = extension.value("diffuseFactor", std::vector<double>(4, 1.0));
    const auto specular = extension.value("specularFactor", std::vector<double>(3, 1.0));
    out.base_color = {share(diffuse[0]), share(diffuse[1]), share(diffuse[2]), share(diffuse[3])};
    out.specular_color = {share(specular[0]), share(specular[1]), share(specular[2])};
    out.metallic = out.ior = 0.0f;
    out.roughness = share(1.0 - glossiness_of(extension));
    out.base_color_texture = textures.convert(extension, "diffuseTexture");
    out.specular_color_texture = textures.convert(extension, "specularGlossinessTexture");
}

void add_roughness_textures(const GltfDocument& document, GltfMaterials& materials) {
    for (std::size_t m = 0; m < document.materials.size(); ++m) {
        const json* extension = find_member(document.materials[m], kGlossinessExtension);
        Material& material = materials.materials[m];
        if (extension == nullptr || !material.specular_color_texture.present()) continue;
        const auto source = static_cast<std::size_t>(material.specular_color_texture.texture);
        const RoughnessImage made{materials.textures[source].image, glossiness_of(*extension)};
        auto& all = materials.roughness;
        const auto place = static_cast<std::size_t>(std::ranges::find(all, made) - all.begin());
        if (place == all.size()) all.push_back(made);
        materials.textures.push_back({static_cast<int>(materials.images.size() + place),
                                      materials.textures[source].sampler});
        material.metallic_roughness_texture = material.specular_color_texture;
        material.metallic_roughness_texture.texture =
            static_cast<int>(materials.textures.size()) - 1;
        material.roughness = 1.0f;
    }
}

std::vector<Image> roughness_images(const GltfDocument& document, const GltfMaterials& materials,
                                    std::span<const Image> images) {
    std::vector<Image> out;
    for (const RoughnessImage& made : materials.roughness) {
        const Image& source = images[static_cast<std::size_t>(made.image)];
        document.budget->charge_memory(source.rgba.size(), document.base.file + ": materials");
        Image& image = out.emplace_back(
            Image{"", source.width, source.height, std::vector<std::uint8_t>(source.rgba.size())});
        for (std::size_t i = 0; i < source.rgba.size(); i += 4) {
            const double roughness = 255.0 - made.glossiness * source.rgba[i + 3];
            image.rgba[i + 1] = static_cast<std::uint8_t>(roughness + 0.5);
            image.rgba[i + 3] = 255;
        }
    }
    return out;
}

}  // namespace kilolux
