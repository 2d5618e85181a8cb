// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "host/scene/gltf/load_scene.h"
#include "tests/scene/expect_near.h"
#include "tests/support/gltf_builder.h"

namespace kilolux {
namespace {

using nlohmann::json;

glm::vec3 bitangent(const Mesh& mesh, std::size_t vertex) {
    const glm::vec4 tangent = mesh.tangents.at(vertex);
    return glm::cross(mesh.normals.at(vertex), glm::vec3(tangent)) * tangent.w;
}

TEST(LoadSceneNormals, GivesFlatNormalsToUnsharedVertices) {
    GltfBuilder file = triangle_file();
    // Two walls of a corner that share an edge.
    file.primitive()["attributes"] = {
        {"POSITION", file.add_floats("VEC3", {0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, -1})}};
    file.primitive()["indices"] = file.add_indices({0, 2, 1, 0, 1, 3});
    const Scene scene = load(file);
    const Mesh& mesh = scene.meshes.at(0);
    EXPECT_EQ(scene_defect(scene), "");
    ASSERT_EQ(mesh.positions.size(), 6u);
    expect_near(mesh.normals[mesh.indices[0]], {0, 0, 1});
    expect_near(mesh.normals[mesh.indices[3]], {-1, 0, 0});
}

TEST(LoadSceneNormals, SurvivesTrianglesWithoutArea) {
    GltfBuilder file = triangle_file();
    for (const std::vector<float>& points :
         {std::vector<float>{1, 1, 1, 1, 1, 1, 1, 1, 1},
          std::vector<float>{0, 0, 0, 1, 0, 0, 2, 0, 0},
          std::vector<float>{0, 0, 0, 1e-45f, 0, 0, 0, 1e-45f, 0},
          std::vector<float>{-3e38f, 0, 0, 3e38f, 0, 0, 0, 3e38f, 0}}) {
        file.primitive()["attributes"] = {{"POSITION", file.add_floats("VEC3", points)}};
        const Scene scene = load(file);
        EXPECT_EQ(scene_defect(scene), "");
        EXPECT_EQ(scene.meshes.size(), 1u);
    }
}

TEST(LoadSceneNormals, MakesNormalsUnitAndMendsZeroOnes) {
    GltfBuilder file = triangle_file();
    file.primitive()["attributes"]["NORMAL"] =
        file.add_floats("VEC3", {0, 5, 0, 0, 0, 0, 1e-30f, 0, 0});
    const Scene scene = load(file);
    EXPECT_EQ(scene_defect(scene), "");
    expect_near(scene.meshes[0].normals[0], {0, 1, 0});
    expect_near(scene.meshes[0].normals[1], {0, 0, 1});
    expect_near(scene.meshes[0].normals[2], {1, 0, 0});
}

TEST(LoadSceneTangents, PointAlongUAndMakeTheImagesUpTheBitangent) {
    const Scene scene = load(quad_with_normal_map());
    EXPECT_EQ(scene_defect(scene), "");
    ASSERT_EQ(scene.meshes[0].tangents.size(), 4u);
    for (std::size_t v = 0; v < 4; ++v) {
        expect_near(glm::vec3(scene.meshes[0].tangents[v]), {1, 0, 0});
        expect_near(bitangent(scene.meshes[0], v), {0, 1, 0});
    }
}

TEST(LoadSceneTangents, TurnWithMirroredTextureCoordinates) {
    GltfBuilder file = quad_with_normal_map();
    file.primitive()["attributes"]["TEXCOORD_0"] =
        file.add_floats("VEC2", {1, 1, 0, 1, 0, 0, 1, 0});
    const Scene scene = load(file);
    expect_near(glm::vec3(scene.meshes[0].tangents[0]), {-1, 0, 0});
    EXPECT_EQ(scene.meshes[0].tangents[0].w, -1.0f);
    expect_near(bitangent(scene.meshes[0], 0), {0, 1, 0});
}

TEST(LoadSceneTangents, SplitVerticesWhereMirroredHalvesMeet) {
    GltfBuilder file = quad_with_normal_map();
    // u runs 1, 0, 1 from left to right: the middle column belongs to both halves.
    file.primitive()["attributes"] = {
        {"POSITION",
         file.add_floats("VEC3", {-1, 0, 0, -1, 1, 0, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0})},
        {"NORMAL", file.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1})},
        {"TEXCOORD_0", file.add_floats("VEC2", {1, 1, 1, 0, 0, 1, 0, 0, 1, 1, 1, 0})}};
    file.primitive()["indices"] = file.add_indices({0, 2, 1, 1, 2, 3, 2, 4, 3, 3, 4, 5});
    const Scene scene = load(file);
    const Mesh& mesh = scene.meshes.at(0);
    EXPECT_EQ(scene_defect(scene), "");
    EXPECT_EQ(mesh.positions.size(), 8u);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const glm::vec3 u_direction(i < 6 ? -1 : 1, 0, 0);
        expect_near(glm::vec3(mesh.tangents[mesh.indices[i]]), u_direction);
        expect_near(bitangent(mesh, mesh.indices[i]), {0, 1, 0});
    }
}

TEST(LoadSceneTangents, AgreeForVerticesThatDifferOnlyInTheirIndex) {
    GltfBuilder file = quad_with_normal_map();
    // A roof of two slopes whose ridge is given twice, with the same normal and texture coordinate.
    const float s = std::sqrt(0.5f);
    file.primitive()["attributes"] = {
        {"POSITION",
         file.add_floats("VEC3", {-1, 0, 0, 0, 0, 1, 0, 1, 1, 1, 0, 0, 0, 1, 1, 0, 0, 1})},
        {"NORMAL",
         file.add_floats("VEC3", {-s, 0, s, 0, 0, 1, 0, 0, 1, s, 0, s, 0, 0, 1, 0, 0, 1})},
        {"TEXCOORD_0", file.add_floats("VEC2", {0, 1, 0.5f, 1, 0.5f, 0, 1, 1, 0.5f, 0, 0.5f, 1})}};
    file.primitive()["indices"] = file.add_indices({0, 1, 2, 3, 4, 5});
    const Mesh mesh = load(file).meshes.at(0);
    expect_near(glm::vec3(mesh.tangents[1]), glm::vec3(mesh.tangents[5]));
    expect_near(glm::vec3(mesh.tangents[1]), {1, 0, 0});
}

TEST(LoadSceneTangents, FollowTheTransformOfTheNormalMap) {
    GltfBuilder file = quad_with_normal_map();
    file.root["materials"][0]["normalTexture"]["extensions"] = {
        {"KHR_texture_transform", {{"scale", {-1, 1}}}}};
    const Scene scene = load(file);
    expect_near(glm::vec3(scene.meshes[0].tangents[0]), {-1, 0, 0});
    expect_near(bitangent(scene.meshes[0], 0), {0, 1, 0});
}

TEST(LoadSceneTangents, UseTheSetThatTheNormalMapUses) {
    GltfBuilder file = quad_with_normal_map();
    file.root["materials"][0]["normalTexture"]["texCoord"] = 1;
    // The second set's u runs upwards.
    file.primitive()["attributes"]["TEXCOORD_1"] =
        file.add_floats("VEC2", {0, 0, 0, 1, 1, 1, 1, 0});
    expect_near(glm::vec3(load(file).meshes[0].tangents[0]), {0, 1, 0});
}

TEST(LoadSceneTangents, SurviveTextureCoordinatesThatSayNothing) {
    for (const bool has_texcoords : {true, false}) {
        GltfBuilder file = quad_with_normal_map();
        file.primitive()["attributes"]["TEXCOORD_0"] =
            file.add_floats("VEC2", {3, 3, 3, 3, 3, 3, 3, 3});
        if (!has_texcoords) file.primitive()["attributes"].erase("TEXCOORD_0");
        const Scene scene = load(file);
        EXPECT_EQ(scene_defect(scene), "");
        EXPECT_EQ(scene.meshes[0].tangents.size(), 4u);
    }
}

TEST(LoadSceneTangents, AreTakenFromTheFileAndMended) {
    GltfBuilder file = quad_with_normal_map();
    file.primitive()["attributes"]["TANGENT"] =
        file.add_floats("VEC4", {0, 2, 0, -1, 0, 1, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0.5f});
    const Scene scene = load(file);
    EXPECT_EQ(scene_defect(scene), "");
    EXPECT_EQ(scene.meshes[0].tangents[0], glm::vec4(0, 1, 0, -1));
    EXPECT_EQ(scene.meshes[0].tangents[3], glm::vec4(0, 1, 0, 1));
}

TEST(LoadSceneTangents, AreLeftOutWithoutANormalMap) {
    GltfBuilder file = quad_with_normal_map();
    file.primitive().erase("material");
    EXPECT_TRUE(load(file).meshes[0].tangents.empty());
}

}  // namespace
}  // namespace kilolux
