// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <glm/gtc/constants.hpp>
#include <iterator>
#include <set>

#include "host/scene/gltf/load_scene.h"
#include "host/scene/material_table.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/messages.h"
#include "tests/support/paths.h"

namespace kilolux {
namespace {

TEST(MaterialTable, TheDocumentHasEachMap) {
    std::ifstream file(source_root() + "/host/scene/README.md");
    const std::string text(std::istreambuf_iterator<char>(file), {});
    for (const MaterialMap& map : kMaterialMaps) {
        const std::string row = "| " + std::string(map.path) + " | " +
                                (map.srgb ? "sRGB" : "linear") + " | " + std::string(map.channels) +
                                " |\n";
        EXPECT_TRUE(contains(text, row)) << row;
    }
}

using nlohmann::json;

// The smallest file whose material shows an image.
GltfBuilder textured_file() {
    GltfBuilder file = triangle_file();
    const int texture = file.add_texture(encode_image("png", 1, 3, {1, 2, 3}), "image/png");
    file.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
    file.primitive()["material"] = 0;
    return file;
}

TEST(LoadSceneMaterial, HasTheDefaultsOfTheSpecification) {
    GltfBuilder file = triangle_file();
    file.add("materials", json::object());
    const Material material = load(file).materials.at(0);
    EXPECT_EQ(material.base_color, glm::vec4(1));
    EXPECT_EQ(material.metallic, 1.0f);
    EXPECT_EQ(material.roughness, 1.0f);
    EXPECT_EQ(material.emissive, glm::vec3(0));
    EXPECT_EQ(material.alpha_mode, AlphaMode::opaque);
    EXPECT_EQ(material.alpha_cutoff, 0.5f);
    EXPECT_EQ(material.ior, 1.5f);
    EXPECT_FALSE(material.double_sided || material.unlit || material.base_color_texture.present());
    EXPECT_EQ(load(triangle_file()).meshes[0].material, -1);
}

TEST(LoadSceneMaterial, ReadsAllFactors) {
    GltfBuilder file = triangle_file();
    file.add("materials", {{"name", "brass"},
                           {"pbrMetallicRoughness",
                            {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}},
                             {"metallicFactor", 0.5},
                             {"roughnessFactor", 0.25}}},
                           {"emissiveFactor", {0.5, 0, 1}},
                           {"alphaMode", "MASK"},
                           {"alphaCutoff", 0.75},
                           {"doubleSided", true}});
    const Material material = load(file).materials.at(0);
    EXPECT_EQ(material.name, "brass");
    EXPECT_EQ(material.base_color, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
    EXPECT_EQ(material.metallic, 0.5f);
    EXPECT_EQ(material.roughness, 0.25f);
    EXPECT_EQ(material.emissive, glm::vec3(0.5f, 0, 1));
    EXPECT_EQ(material.alpha_mode, AlphaMode::mask);
    EXPECT_EQ(material.alpha_cutoff, 0.75f);
    EXPECT_TRUE(material.double_sided);
}

TEST(LoadSceneMaterial, ClampsFactorsToTheirRanges) {
    GltfBuilder file = triangle_file();
    file.add(
        "materials",
        {{"pbrMetallicRoughness",
          {{"baseColorFactor", {-1, 2, 1e300, 1}}, {"metallicFactor", -3}, {"roughnessFactor", 7}}},
         {"alphaMode", "BLEND"}});
    const Material material = load(file).materials.at(0);
    EXPECT_EQ(material.base_color, glm::vec4(0, 1, 1, 1));
    EXPECT_EQ(material.metallic, 0.0f);
    EXPECT_EQ(material.roughness, 1.0f);
    EXPECT_EQ(material.alpha_mode, AlphaMode::blend);
}

TEST(LoadSceneMaterial, ReadsMaterialExtensions) {
    GltfBuilder file = triangle_file();
    file.add("materials", {{"emissiveFactor", {1, 0.5, 0}},
                           {"extensions",
                            {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}},
                             {"KHR_materials_ior", {{"ior", 1.33}}},
                             {"KHR_materials_specular",
                              {{"specularFactor", 0.25}, {"specularColorFactor", {1, 2, 0.5}}}}}}});
    const Material material = load(file).materials.at(0);
    EXPECT_EQ(material.emissive, glm::vec3(8, 4, 0));
    EXPECT_FALSE(material.unlit);
    EXPECT_FLOAT_EQ(material.ior, 1.33f);
    EXPECT_EQ(material.specular, 0.25f);
    EXPECT_EQ(material.specular_color, glm::vec3(1, 2, 0.5f));
}

TEST(LoadSceneMaterial, AnUnlitMaterialReflectsNothing) {
    GltfBuilder file = triangle_file();
    file.add("materials",
             {{"extensions",
               {{"KHR_materials_unlit", json::object()}, {"KHR_materials_ior", {{"ior", 1.33}}}}}});
    const Material material = load(file).materials.at(0);
    EXPECT_TRUE(material.unlit);
    EXPECT_EQ(material.ior, Material{}.ior);
}

TEST(LoadSceneMaterial, KeepsHugeIntegersOfExtensions) {
    GltfBuilder file = triangle_file();
    file.add("materials",
             {{"emissiveFactor", {1, 1, 1}},
              {"extensions",
               {{"KHR_materials_emissive_strength", {{"emissiveStrength", 5000000000}}}}}});
    EXPECT_FLOAT_EQ(load(file).materials.at(0).emissive.x, 5e9f);
}

TEST(LoadSceneMaterial, ReadsAllTextureSlots) {
    GltfBuilder file = triangle_file();
    const Blob png = encode_image("png", 1, 3, {1, 2, 3});
    for (int i = 0; i < 5; ++i) file.add_texture(png, "image/png");
    file.add("materials", {{"pbrMetallicRoughness",
                            {{"baseColorTexture", {{"index", 4}, {"texCoord", 1}}},
                             {"metallicRoughnessTexture", {{"index", 3}}}}},
                           {"normalTexture", {{"index", 2}, {"scale", 0.5}}},
                           {"occlusionTexture", {{"index", 1}, {"strength", 0.25}}},
                           {"emissiveTexture", {{"index", 0}}}});
    const Scene scene = load(file);
    const Material& m = scene.materials.at(0);
    EXPECT_EQ(scene_defect(scene), "");
    EXPECT_EQ(scene.images.size(), 5u);
    EXPECT_EQ(m.base_color_texture.uv_set, 1);
    EXPECT_EQ(m.normal_scale, 0.5f);
    EXPECT_EQ(m.occlusion_strength, 0.25f);
    const std::set<int> distinct = {m.base_color_texture.texture,
                                    m.metallic_roughness_texture.texture, m.normal_texture.texture,
                                    m.occlusion_texture.texture, m.emissive_texture.texture};
    EXPECT_EQ(distinct, (std::set<int>{0, 1, 2, 3, 4}));
}

TEST(LoadSceneMaterial, DecodesOnlyTheImagesThatMaterialsUseAndEachOnce) {
    GltfBuilder file = textured_file();
    file.add("images", {{"uri", "not there.png"}});
    file.add("textures", {{"source", 0}, {"sampler", 0}});
    file.add("samplers", {{"wrapS", 33071}});
    file.root["materials"][0]["emissiveTexture"] = {{"index", 1}};
    const Scene scene = load(file);
    EXPECT_EQ(scene.images.size(), 1u);
    EXPECT_EQ(scene.textures.size(), 2u);
}

TEST(LoadSceneMaterial, ReadsSamplers) {
    const auto sampler_of = [](const json& sampler) {
        GltfBuilder file = textured_file();
        file.root["textures"][0]["sampler"] = file.add("samplers", sampler);
        return load(file).textures.at(0).sampler;
    };
    const Sampler none = load(textured_file()).textures.at(0).sampler;
    EXPECT_EQ(none.wrap_s, Wrap::repeat);
    EXPECT_TRUE(none.mipmaps);
    EXPECT_EQ(none.minify, Filter::linear);
    const Sampler wrapped = sampler_of({{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}});
    EXPECT_EQ(wrapped.wrap_s, Wrap::clamp);
    EXPECT_EQ(wrapped.wrap_t, Wrap::mirror);
    EXPECT_EQ(wrapped.magnify, Filter::nearest);
    struct Minify {
        int code;
        Filter minify;
        bool mipmaps;
        Filter between;
    };
    for (const Minify& m : {Minify{9728, Filter::nearest, false, Filter::linear},
                            Minify{9729, Filter::linear, false, Filter::linear},
                            Minify{9984, Filter::nearest, true, Filter::nearest},
                            Minify{9985, Filter::linear, true, Filter::nearest},
                            Minify{9986, Filter::nearest, true, Filter::linear},
                            Minify{9987, Filter::linear, true, Filter::linear}}) {
        const Sampler sampler = sampler_of({{"minFilter", m.code}});
        EXPECT_EQ(sampler.minify, m.minify) << m.code;
        EXPECT_EQ(sampler.mipmaps, m.mipmaps) << m.code;
        if (m.mipmaps) {
            EXPECT_EQ(sampler.between_mipmaps, m.between) << m.code;
        }
    }
}

TEST(LoadSceneMaterial, TransformsTextureCoordinates) {
    GltfBuilder file = textured_file();
    // The extension's own example: the lower left quadrant, turned by 90 degrees.
    file.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {
        {"KHR_texture_transform",
         {{"offset", {0, 1}},
          {"rotation", glm::half_pi<double>()},
          {"scale", {0.5, 0.5}},
          {"texCoord", 1}}}};
    const TextureUse use = load(file).materials.at(0).base_color_texture;
    EXPECT_EQ(use.uv_set, 1);
    const glm::vec3 far = use.uv_from_texcoord * glm::vec3(1, 1, 1);
    EXPECT_NEAR(far.x, 0.5f, 1e-6f);
    EXPECT_NEAR(far.y, 0.5f, 1e-6f);
    const glm::vec3 right = use.uv_from_texcoord * glm::vec3(1, 0, 1);
    EXPECT_NEAR(right.x, 0.0f, 1e-6f);
    EXPECT_NEAR(right.y, 0.5f, 1e-6f);
}

TEST(LoadSceneMaterial, PacksTheTextureCoordinateSetsThatAreUsed) {
    GltfBuilder file = textured_file();
    file.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 2;
    file.root["materials"][0]["emissiveTexture"] = {{"index", 0}, {"texCoord", 5}};
    file.root["materials"][0]["occlusionTexture"] = {{"index", 0}, {"texCoord", 7}};
    for (const int set : {0, 2, 5, 7}) {
        const auto v = static_cast<float>(set);
        file.primitive()["attributes"]["TEXCOORD_" + std::to_string(set)] =
            file.add_floats("VEC2", {v, v, v, v, v, v});
    }
    const Scene scene = load(file);
    const Material& m = scene.materials.at(0);
    const auto set_of = [&](const TextureUse& use) {
        return scene.meshes[0].texcoords[static_cast<std::size_t>(use.uv_set)].at(0).x;
    };
    EXPECT_EQ(set_of(m.base_color_texture), 2.0f);
    EXPECT_EQ(set_of(m.emissive_texture), 5.0f);
    EXPECT_FALSE(m.occlusion_texture.present());
}

TEST(LoadSceneMaterial, ReadsNormalizedTextureCoordinates) {
    GltfBuilder file = triangle_file();
    const Blob bytes = bytes_of<std::uint16_t>({0, 0, 65535, 13107, 0, 65535});
    file.primitive()["attributes"]["TEXCOORD_0"] =
        file.add_accessor(bytes, {kUnsignedShort, "VEC2", 3, true, 0});
    const auto texcoords = load(file).meshes[0].texcoords;
    EXPECT_EQ(texcoords[0].at(1), glm::vec2(1.0f, 0.2f));
    EXPECT_TRUE(texcoords[1].empty());
}

}  // namespace
}  // namespace kilolux
