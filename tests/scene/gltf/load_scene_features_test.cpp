// SPDX-License-Identifier: Apache-2.0
// Details of extensions and features of real files: their defaults, and their combination.
#include <gtest/gtest.h>

#include <random>

#include "host/scene/gltf/load_scene.h"
#include "tests/scene/expect_near.h"
#include "tests/support/gltf_builder.h"

namespace kilolux {
namespace {

using nlohmann::json;

Material material_with(const char* extension, const json& value, json material = json::object()) {
    GltfBuilder file = triangle_file();
    material["extensions"] = {{extension, value}};
    file.add("materials", material);
    return load(file).materials.at(0);
}

TEST(LoadSceneFeatures, IndexOfRefractionGivesTheReflectance) {
    const auto material = [](const json& value) {
        return material_with("KHR_materials_ior", value);
    };
    EXPECT_EQ(dielectric_reflectance(material(json::object())).x, 0.04f) << "1.5, the default";
    EXPECT_FALSE(has_own_reflectance(material({{"ior", 1.5}})));
    EXPECT_NEAR(dielectric_reflectance(material({{"ior", 2}})).x, 1.0 / 9.0, 1e-7);
    EXPECT_EQ(dielectric_reflectance(material({{"ior", 1}})).x, 0.0f);
    EXPECT_EQ(dielectric_reflectance(material({{"ior", 0}})).x, 1.0f) << "0 stands for a mirror";
    EXPECT_EQ(dielectric_reflectance(material({{"ior", 0.5}})).x, 0.0f) << "no less than vacuum";
}

TEST(LoadSceneFeatures, SpecularHasTexturesAndDefaults) {
    GltfBuilder file = triangle_file();
    const Blob png = encode_image("png", 1, 4, {1, 2, 3, 4});
    for (int i = 0; i < 2; ++i) file.add_texture(png, "image/png");
    const json transform = {{"KHR_texture_transform", {{"offset", {0.5, 0}}}}};
    file.add("materials",
             {{"extensions",
               {{"KHR_materials_specular",
                 {{"specularTexture", {{"index", 1}, {"texCoord", 1}}},
                  {"specularColorTexture", {{"index", 0}, {"extensions", transform}}}}}}}});
    const Scene scene = load(file);
    EXPECT_EQ(scene_defect(scene), "");
    const Material& m = scene.materials.at(0);
    ASSERT_TRUE(m.specular_texture.present() && m.specular_color_texture.present());
    EXPECT_NE(m.specular_texture.texture, m.specular_color_texture.texture);
    EXPECT_EQ(m.specular_texture.uv_set, 1);
    EXPECT_EQ(m.specular_color_texture.uv_set, 0);
    EXPECT_EQ(m.specular_color_texture.uv_from_texcoord[2].x, 0.5f);
    EXPECT_EQ(m.specular, 1.0f);
    EXPECT_EQ(m.specular_color, glm::vec3(1.0f));
}

TEST(LoadSceneFeatures, SpecularTexturesObeyTheRulesOfTextureSlots) {
    for (const char* slot : {"specularTexture", "specularColorTexture"}) {
        const auto expect_error = [&](const json& texture, const std::string& what) {
            GltfBuilder file = triangle_file();
            file.add_texture(encode_image("png", 1, 4, {1, 2, 3, 4}), "image/png");
            file.add("materials", json::object());
            file.add("materials",
                     {{"extensions", {{"KHR_materials_specular", {{slot, texture}}}}}});
            const std::string expected =
                std::string("materials[1].extensions.KHR_materials_specular.") + slot + what;
            const std::string error = load_error(file);
            EXPECT_NE(error.find(expected), std::string::npos) << error;
        };
        const auto transformed = [](const json& transform) -> json {
            return {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}};
        };
        const std::string transform = ".extensions.KHR_texture_transform.";
        expect_error({{"index", 1}}, ".index is 1, must be an index into the 1 textures");
        expect_error({{"texCoord", 0}}, ".index is missing");
        expect_error({{"index", 0}, {"texCoord", -1}}, ".texCoord is -1, must be an integer");
        expect_error(7, " is 7, must be an object");
        expect_error({{"index", 0}, {"extensions", {1}}}, ".extensions is [1], must be an object");
        expect_error(transformed({{"offset", {1}}}),
                     transform + "offset is [1], must be an array of 2 numbers");
        expect_error(transformed({{"scale", {1, "x"}}}), transform + "scale is [1,\"x\"]");
        expect_error(transformed({{"rotation", "x"}}), transform + "rotation is \"x\"");
        expect_error(transformed({{"texCoord", -2}}), transform + "texCoord is -2");
    }
}

TEST(LoadSceneFeatures, EmissiveStrengthScalesWhatIsThere) {
    const json emissive = {{"emissiveFactor", {0.5, 0.25, 1}}};
    const auto strength = [&](const json& value) {
        return material_with("KHR_materials_emissive_strength", value, emissive).emissive;
    };
    EXPECT_EQ(strength(json::object()), glm::vec3(0.5f, 0.25f, 1)) << "1, the default";
    EXPECT_EQ(strength({{"emissiveStrength", 0}}), glm::vec3(0.0f));
    EXPECT_EQ(strength({{"emissiveStrength", 1000.5}}), glm::vec3(500.25f, 250.125f, 1000.5f));
    EXPECT_EQ(strength({{"emissiveStrength", -1}}), glm::vec3(0.0f)) << "no negative light";
}

// Scale, then rotate, then shift: with scales that differ the order shows.
TEST(LoadSceneFeatures, TextureTransformsScaleThenRotateThenShift) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> any(-2.0, 2.0);
    for (int i = 0; i < 32; ++i) {
        const double ox = any(random), oy = any(random), sx = any(random), sy = any(random);
        const double angle = any(random), u = any(random), v = any(random);
        json transform = {{"rotation", angle}};
        if (i % 2 == 0) transform["offset"] = {ox, oy};
        if (i % 4 < 2) transform["scale"] = {sx, sy};
        GltfBuilder file = quad_with_normal_map();
        file.root["materials"][0]["normalTexture"]["extensions"]["KHR_texture_transform"] =
            transform;
        const TextureUse use = load(file).materials.at(0).normal_texture;
        const double su = i % 4 < 2 ? sx * u : u;
        const double sv = i % 4 < 2 ? sy * v : v;
        const glm::dvec3 expected(
            std::cos(angle) * su + std::sin(angle) * sv + (i % 2 == 0 ? ox : 0.0),
            -std::sin(angle) * su + std::cos(angle) * sv + (i % 2 == 0 ? oy : 0.0), 1.0);
        expect_near(glm::dvec3(use.uv_from_texcoord * glm::vec3(u, v, 1.0f)), expected, 1e-5);
        EXPECT_EQ(use.uv_set, 0);
    }
    GltfBuilder file = quad_with_normal_map();
    file.root["materials"][0]["normalTexture"]["extensions"]["KHR_texture_transform"] =
        json::object();
    EXPECT_EQ(load(file).materials.at(0).normal_texture.uv_from_texcoord, glm::mat3(1.0f));
}

// Tangents come from the normal map's coordinates, else from those of the coat's.
TEST(LoadSceneFeatures, ANormalMapOfACoatHasTangents) {
    GltfBuilder file = quad_with_normal_map();
    json& material = file.root["materials"][0];
    const json map = material["normalTexture"];
    material["extensions"]["KHR_materials_clearcoat"]["clearcoatNormalTexture"] = map;
    const std::vector<glm::vec4> usual = load(file).meshes.at(0).tangents;
    EXPECT_EQ(usual.size(), 4u);
    material.erase("normalTexture");
    EXPECT_EQ(load(file).meshes.at(0).tangents, usual);
    material.erase("extensions");
    EXPECT_TRUE(load(file).meshes.at(0).tangents.empty());
}

// Also without a map, by the first texture coordinates.
TEST(LoadSceneFeatures, AnisotropyHasTangents) {
    GltfBuilder file = quad_with_normal_map();
    json& material = file.root["materials"][0];
    const json map = material["normalTexture"];
    const std::vector<glm::vec4> usual = load(file).meshes.at(0).tangents;
    material.erase("normalTexture");
    json& anisotropy = material["extensions"]["KHR_materials_anisotropy"];
    anisotropy = {{"anisotropyRotation", 1.0}, {"anisotropyStrength", 0.5}};
    EXPECT_EQ(load(file).meshes.at(0).tangents, usual);
    anisotropy["anisotropyStrength"] = 0.0;
    EXPECT_TRUE(load(file).meshes.at(0).tangents.empty());
    anisotropy["anisotropyTexture"] = map;
    EXPECT_EQ(load(file).meshes.at(0).tangents, usual);
}

// The output of gltfpack: all attributes in small integers, scaled by the texture's transform.
TEST(LoadSceneFeatures, QuantizedAttributesOfAllKinds) {
    GltfBuilder file = quad_with_normal_map();
    json& attributes = file.primitive()["attributes"];
    attributes["POSITION"] =
        file.add_accessor(bytes_of<std::uint16_t>({0, 0, 0, 0, 65535, 0, 0, 0,  //
                                                   65535, 65535, 0, 0, 0, 65535, 0, 0}),
                          {kUnsignedShort, "VEC3", 4, true, 8});
    attributes["NORMAL"] = file.add_accessor(
        bytes_of<std::int16_t>({0, 0, 32767, 0, 0, 0, 32767, 0, 0, 0, 32767, 0, 0, 0, 32767, 0}),
        {kShort, "VEC3", 4, true, 8});
    const Blob tangents =
        bytes_of<std::int8_t>({127, 0, 0, -127, 127, 0, 0, -127, 127, 0, 0, 127, 127, 0, 0, 127});
    attributes["TANGENT"] = file.add_accessor(tangents, {kByte, "VEC4", 4, true, 0});
    attributes["TEXCOORD_0"] =
        file.add_accessor(bytes_of<std::uint16_t>({0, 4096, 4096, 4096, 4096, 0, 0, 0}),
                          {kUnsignedShort, "VEC2", 4, false, 0});
    const Blob delta = bytes_of<std::int8_t>({0, 0, 0, 0, 0, 0, 127, 0, 0, 0, -127, 0, 0, 0, 0, 0});
    file.primitive()["targets"] = {
        {{"POSITION", file.add_accessor(delta, {kByte, "VEC3", 4, true, 4})}}};
    file.root["meshes"][0]["weights"] = {0.5};
    file.root["materials"][0]["normalTexture"]["extensions"]["KHR_texture_transform"] = {
        {"scale", {1.0 / 4096, 1.0 / 4096}}};
    file.root["extensionsRequired"] = {"KHR_mesh_quantization", "KHR_texture_transform"};
    const Scene scene = load(file);
    EXPECT_EQ(scene_defect(scene), "");
    const Mesh& mesh = scene.meshes.at(0);
    expect_near(mesh.positions[1], {1, 0, 0.5});
    expect_near(mesh.positions[2], {1, 1, -0.5});
    expect_near(mesh.normals[3], {0, 0, 1});
    EXPECT_EQ(mesh.tangents[0], glm::vec4(1, 0, 0, -1));
    EXPECT_EQ(mesh.tangents[2], glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(mesh.texcoords[0][1], glm::vec2(4096, 4096));
    const glm::mat3& uv = scene.materials.at(0).normal_texture.uv_from_texcoord;
    expect_near(glm::dvec3(uv * glm::vec3(mesh.texcoords[0][1], 1)), {1, 1, 1});
}

// A joint that turns by 90 degrees about z in a second, from a rest 2 away along x.
GltfBuilder turning_skin() {
    GltfBuilder file = quad_with_normal_map();
    json& attributes = file.primitive()["attributes"];
    attributes["TANGENT"] =
        file.add_floats("VEC4", {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1});
    // All weight in the second set, in normalized shorts; the first set's joint weighs nothing.
    attributes["JOINTS_0"] = file.add_accessor(Blob(16), {kUnsignedByte, "VEC4", 4, false, 0});
    attributes["WEIGHTS_0"] = file.add_accessor(Blob(16), {kUnsignedByte, "VEC4", 4, true, 0});
    attributes["JOINTS_1"] =
        file.add_accessor(bytes_of<std::uint16_t>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}),
                          {kUnsignedShort, "VEC4", 4, false, 0});
    attributes["WEIGHTS_1"] = file.add_accessor(
        bytes_of<std::uint16_t>({65535, 0, 0, 0, 65535, 0, 0, 0, 65535, 0, 0, 0, 65535, 0, 0, 0}),
        {kUnsignedShort, "VEC4", 4, true, 0});
    const int bind = file.add_floats("MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,  //
                                              1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -2, 0, 0, 1});
    file.add("skins", {{"joints", {1, 2}}, {"inverseBindMatrices", bind}});
    file.root["nodes"][0]["skin"] = 0;
    file.add_node(json::object());
    file.add_node({{"translation", {2, 0, 0}}});
    const float half = std::sqrt(0.5f);
    const int input = file.add_floats("SCALAR", {0, 1});
    const int output = file.add_floats("VEC4", {0, 0, 0, 1, 0, 0, half, half});
    file.add("animations",
             {{"samplers", {{{"input", input}, {"output", output}}}},
              {"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "rotation"}}}}}}});
    return file;
}

TEST(LoadSceneFeatures, SkinsTurnPositionsNormalsAndTangentsWithTime) {
    const GltfBuilder file = turning_skin();
    const Scene rest = load(file);
    EXPECT_EQ(scene_defect(rest), "");
    expect_near(world_positions(rest)[1], {1, 0, 0});
    LoadOptions options;
    options.time = 1.0;
    const Scene turned = load(file, options);
    EXPECT_EQ(scene_defect(turned), "");
    // About (2, 0, 0): (0, 0) goes to (2, -2), (1, 1) to (1, -1).
    expect_near(world_positions(turned)[0], {2, -2, 0});
    expect_near(world_positions(turned)[2], {1, -1, 0});
    const Mesh& mesh = turned.meshes.at(0);
    expect_near(mesh.normals[0], {0, 0, 1});
    expect_near(glm::dvec3(glm::vec3(mesh.tangents[0])), {0, 1, 0});
    EXPECT_EQ(mesh.tangents[0].w, 1.0f);
}

TEST(LoadSceneFeatures, MorphTargetsComeBeforeTheSkin) {
    GltfBuilder file = turning_skin();
    const int delta = file.add_floats("VEC3", {3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    file.primitive()["targets"] = {{{"POSITION", delta}}};
    file.root["meshes"][0]["weights"] = {1.0};
    LoadOptions options;
    options.time = 1.0;
    // (3, 0) about (2, 0): one along what was x, which is y now. After the skin it were (5, -2).
    expect_near(world_positions(load(file, options))[0], {2, 1, 0});
}

}  // namespace
}  // namespace kilolux
