// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/material/specular_glossiness.h"

#include <algorithm>
#include <cmath>

namespace kilolux {
namespace {

using nlohmann::json;

constexpr const char* kGlossinessExtension = "extensions.KHR_materials_pbrSpecularGlossiness";
constexpr double kDielectric = 0.04;  // reflectance head on of metallic-roughness's dielectrics
constexpr double kLeast = 1e-6;       // keeps divisions finite; what they multiply is then 0

double max_of(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }

// Weights of ITU-R BT.601 on squares, as the extension's conversion has them.
double perceived_brightness(const glm::dvec3& color) {
    return std::sqrt(glm::dot(glm::dvec3(0.299, 0.587, 0.114), color * color));
}

double solve_metallic(double diffuse, double specular, double diffuse_share) {
    if (specular < kDielectric) return 0.0;
    const double a = kDielectric;
    const double b = diffuse * diffuse_share / (1.0 - kDielectric) + specular - 2.0 * kDielectric;
    const double c = kDielectric - specular;
    const double root = std::sqrt(std::max(b * b - 4.0 * a * c, 0.0));
    return std::clamp((-b + root) / (2.0 * a), 0.0, 1.0);
}

double clamped_unit(double value) { return std::clamp(value, 0.0, 1.0); }

glm::dvec3 colour_of(const std::vector<double>& numbers) {
    return {clamped_unit(numbers[0]), clamped_unit(numbers[1]), clamped_unit(numbers[2])};
}

// The extension's factors, and the opacity.
SpecularGlossiness read_factors(const json& extension, double& alpha) {
    const auto diffuse = extension.value("diffuseFactor", std::vector<double>(4, 1.0));
    const auto specular = extension.value("specularFactor", std::vector<double>(3, 1.0));
    alpha = clamped_unit(diffuse[3]);
    return {colour_of(diffuse), colour_of(specular),
            clamped_unit(extension.value("glossinessFactor", 1.0))};
}

void set_factors(Material& material, const SpecularGlossiness& factors, double alpha) {
    const MetallicRoughness made = metallic_roughness_of(factors);
    material.base_color = glm::vec4(glm::dvec4(made.base_color, alpha));
    material.metallic = static_cast<float>(made.metallic);
    material.roughness = static_cast<float>(made.roughness);
}

// The place of the two textures among the file's converted ones; new where they differ from all.
std::size_t place_of(GltfMaterials& materials, const ConvertedTextures& textures) {
    auto& all = materials.converted;
    const auto found = std::find(all.begin(), all.end(), textures);
    const auto place = static_cast<std::size_t>(found - all.begin());
    if (found == all.end()) all.push_back(textures);
    return place;
}

// Gives a material its textures, with the layout and sampler of those that they are made of.
void set_textures(const GltfDocument& document, GltfMaterials& materials, Material& material,
                  const json& extension, const SpecularGlossiness& factors) {
    FileTextures sources(document);
    const TextureUse diffuse = sources.convert(extension, "diffuseTexture");
    const TextureUse glossy = sources.convert(extension, "specularGlossinessTexture");
    if (!diffuse.present() && !glossy.present()) return;
    const auto texture_of = [&](const TextureUse& use) {
        return sources.textures()[static_cast<std::size_t>(use.texture)];
    };
    const auto image_of = [&](const TextureUse& use) {
        return use.present() ? sources.images()[static_cast<std::size_t>(texture_of(use).image)]
                             : -1;
    };
    const bool both = diffuse.present() && glossy.present();
    const bool same_layout = !both || (diffuse.uv_set == glossy.uv_set &&
                                       diffuse.uv_from_texcoord == glossy.uv_from_texcoord);
    const std::size_t place =
        place_of(materials, {factors, image_of(diffuse), image_of(glossy), same_layout});
    const auto add = [&](TextureUse use, std::size_t which) {
        const std::size_t image = materials.images.size() + 2 * place + which;
        materials.textures.push_back({static_cast<int>(image), texture_of(use).sampler});
        use.texture = static_cast<int>(materials.textures.size()) - 1;
        return use;
    };
    material.base_color_texture = add(diffuse.present() ? diffuse : glossy, 0);
    material.metallic_roughness_texture = add(glossy.present() ? glossy : diffuse, 1);
    material.base_color = glm::vec4(1.0f, 1.0f, 1.0f, material.base_color.w);
    material.metallic = material.roughness = 1.0f;
    if (!same_layout) {
        document.leave_out(fmt::format(
            "material '{}' lays its diffuse and specular textures out in two ways: each is "
            "converted with the mean of the other",
            shown_uri(material.name)));
    }
}

}  // namespace

MetallicRoughness metallic_roughness_of(const SpecularGlossiness& from) {
    const double diffuse_share = 1.0 - max_of(from.specular);
    const double metallic = solve_metallic(perceived_brightness(from.diffuse),
                                           perceived_brightness(from.specular), diffuse_share);
    const glm::dvec3 by_diffuse =
        from.diffuse * (diffuse_share / (1.0 - kDielectric) / std::max(1.0 - metallic, kLeast));
    const glm::dvec3 by_specular =
        (from.specular - kDielectric * (1.0 - metallic)) / std::max(metallic, kLeast);
    const glm::dvec3 base = glm::mix(by_diffuse, by_specular, metallic * metallic);
    return {glm::clamp(base, 0.0, 1.0), metallic, 1.0 - from.glossiness};
}

bool is_specular_glossiness(const json& material) {
    return find_member(material, kGlossinessExtension) != nullptr;
}

void convert_specular_glossiness(const GltfDocument& document, GltfMaterials& materials) {
    std::size_t count = 0;
    for (std::size_t m = 0; m < materials.materials.size(); ++m) {
        const json* extension = find_member(document.materials[m], kGlossinessExtension);
        if (extension == nullptr) continue;
        double alpha = 1.0;
        const SpecularGlossiness factors = read_factors(*extension, alpha);
        set_factors(materials.materials[m], factors, alpha);
        set_textures(document, materials, materials.materials[m], *extension, factors);
        ++count;
    }
    if (count == 0) return;
    document.leave_out(
        fmt::format("{} specular-glossiness materials are converted to metallic-roughness, which "
                    "changes some coloured ones; gltf-transform metalrough in.glb out.glb converts "
                    "them without that error",
                    count));
}

}  // namespace kilolux
