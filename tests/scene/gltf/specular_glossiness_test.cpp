// SPDX-License-Identifier: Apache-2.0
// KHR_materials_pbrSpecularGlossiness as materials of ior 0 with a specular colour.
#include <gtest/gtest.h>

#include "tests/support/gltf_builder.h"

namespace kilolux {
namespace {

using nlohmann::json;

constexpr const char* kName = "KHR_materials_pbrSpecularGlossiness";

GltfBuilder file_with(const json& extension) {
    GltfBuilder file = triangle_file();
    file.root["extensionsRequired"] = {kName};
    file.add("materials", {{"name", "old"},
                           {"pbrMetallicRoughness", {{"baseColorFactor", {1, 0, 0, 1}}}},
                           {"extensions", {{kName, extension}}}});
    return file;
}

TEST(SpecularGlossiness, FactorsWinOverTheFallbackAndHaveDefaults) {
    const Material metal = load(file_with({{"diffuseFactor", {0, 0.25, 0, 0.5}},
                                           {"specularFactor", {1.0, 0.75, 0.25}},
                                           {"glossinessFactor", 0.875}}))
                               .materials.at(0);
    EXPECT_EQ(metal.metallic, 0.0f);
    EXPECT_EQ(metal.base_color, glm::vec4(0.0f, 0.25f, 0.0f, 0.5f));
    EXPECT_EQ(dielectric_reflectance(metal), glm::vec3(1.0f, 0.75f, 0.25f));
    EXPECT_EQ(metal.roughness, 0.125f);
    const Material mirror = load(file_with({{"glossinessFactor", 1}})).materials.at(0);
    EXPECT_EQ(mirror.base_color, glm::vec4(1.0f)) << "all white by default";
    EXPECT_EQ(dielectric_reflectance(mirror), glm::vec3(1.0f));
    EXPECT_EQ(mirror.roughness, 0.0f);
}

TEST(SpecularGlossiness, NothingIsLost) {
    LoadOptions strict;
    strict.strict = true;
    EXPECT_EQ(load(file_with({{"glossinessFactor", 1}}), strict).materials.size(), 1u);
}

const Image& image_of(const Scene& scene, const TextureUse& use) {
    const auto texture = static_cast<std::size_t>(use.texture);
    return scene.images.at(static_cast<std::size_t>(scene.textures.at(texture).image));
}

// Two images; the specular one is laid out in its own way.
GltfBuilder glossy_file() {
    GltfBuilder file =
        file_with({{"diffuseFactor", {0.5, 1, 1, 0.25}},
                   {"glossinessFactor", 0.75},
                   {"diffuseTexture", {{"index", 0}}},
                   {"specularGlossinessTexture",
                    {{"index", 1},
                     {"texCoord", 1},
                     {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0}}}}}}}}});
    const Blob diffuse = {200, 20, 90, 255, 10, 240, 5, 128};
    const Blob glossy = {230, 180, 90, 200, 40, 40, 60, 100};
    file.add_texture(encode_image("png", 2, 4, diffuse), "image/png");
    file.add_texture(encode_image("png", 2, 4, glossy), "image/png");
    return file;
}

TEST(SpecularGlossiness, TexturesStayAndRoughnessIsMadeOfGlossiness) {
    const Scene scene = load(glossy_file());
    EXPECT_EQ(scene_defect(scene), "");
    ASSERT_EQ(scene.images.size(), 3u);
    const Material& m = scene.materials.at(0);
    EXPECT_EQ(image_of(scene, m.base_color_texture).rgba,
              (Blob{200, 20, 90, 255, 10, 240, 5, 128}));
    EXPECT_EQ(image_of(scene, m.specular_color_texture).rgba,
              (Blob{230, 180, 90, 200, 40, 40, 60, 100}));
    EXPECT_EQ(image_of(scene, m.metallic_roughness_texture).rgba,
              (Blob{0, 105, 0, 255, 0, 180, 0, 255}));
    EXPECT_EQ(m.base_color, glm::vec4(0.5f, 1.0f, 1.0f, 0.25f));
    EXPECT_EQ(m.roughness, 1.0f);
    EXPECT_EQ(m.base_color_texture.uv_set, 0);
    for (const TextureUse* use : {&m.specular_color_texture, &m.metallic_roughness_texture}) {
        EXPECT_EQ(use->uv_set, 1);
        EXPECT_EQ(use->uv_from_texcoord[2].x, 0.5f);
    }
}

TEST(SpecularGlossiness, WithoutATextureItsFactorIsTheRoughness) {
    GltfBuilder file = glossy_file();
    file.root["materials"][0]["extensions"][kName].erase("specularGlossinessTexture");
    const Scene scene = load(file);
    EXPECT_EQ(scene.images.size(), 1u);
    EXPECT_EQ(scene.materials.at(0).roughness, 0.25f);
    EXPECT_FALSE(scene.materials.at(0).metallic_roughness_texture.present());
}

TEST(SpecularGlossiness, MaterialsOfTheSameTextureShareItsRoughness) {
    GltfBuilder file = glossy_file();
    file.root["materials"].push_back(file.root["materials"][0]);
    EXPECT_EQ(load(file).images.size(), 3u);
    file.root["materials"][1]["extensions"][kName]["glossinessFactor"] = 0.5;
    EXPECT_EQ(load(file).images.size(), 4u);
}

}  // namespace
}  // namespace kilolux
