// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/load_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "tests/scene/expect_near.h"
#include "tests/support/gltf_builder.h"

namespace kilolux {
namespace {

using nlohmann::json;

// float32 arithmetic of a few operations on values near 1.
TEST(LoadScene, ReadsATriangleFromGltfAndFromGlb) {
    const GltfBuilder file = triangle_file();
    const TempFolder folder;
    write_file(folder.path() / "a.gltf", file.gltf());
    write_file(folder.path() / "b.glb", file.glb());
    for (const char* name : {"a.gltf", "b.glb"}) {
        const Scene scene = load_scene(folder.path() / name);
        EXPECT_EQ(scene_defect(scene), "");
        ASSERT_EQ(scene.meshes.size(), 1u) << name;
        EXPECT_EQ(scene.meshes[0].indices, (std::vector<std::uint32_t>{0, 1, 2}));
        expect_near(world_positions(scene)[1], {1, 0, 0});
    }
}

TEST(LoadScene, LoadsAFileWithoutAnything) {
    const Scene scene = load(GltfBuilder{});
    EXPECT_TRUE(scene.meshes.empty());
    EXPECT_TRUE(scene.instances.empty());
    EXPECT_TRUE(bounds(scene).empty());
}

TEST(LoadScene, MultipliesTransformsDownTheHierarchyInDouble) {
    GltfBuilder file = triangle_file();
    file.root["nodes"] = {
        {{"translation", {1e9, 0, 0}}, {"children", {1}}},
        {{"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}, {"children", {2}}},
        {{"translation", {0.0078125, 0, 0}}, {"scale", {-2, 3, 0.5}}, {"mesh", 0}}};
    const Scene scene = load(file);
    // 1e9 + 0.0078125 needs 37 bits of mantissa; a quarter turn maps x to y.
    const auto positions = world_positions(scene);
    expect_near(positions[0] - glm::dvec3(1e9, 0, 0), {0, 0.0078125, 0});
    expect_near(positions[1] - glm::dvec3(1e9, 0, 0), {0, 0.0078125 - 2.0, 0});
    expect_near(positions[2] - glm::dvec3(1e9, 0, 0), {-3, 0.0078125, 0});
}

TEST(LoadScene, TakesMatricesAsTheyAre) {
    GltfBuilder file = triangle_file();
    const std::vector<double> sheared = {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, -1, 0, 7, 8, 9, 1};
    file.root["nodes"][0]["matrix"] = sheared;
    const Scene scene = load(file);
    expect_near(world_positions(scene)[2], {7.5, 9, 9});
    EXPECT_EQ(scene.instances[0].world_from_object[2][2], -1.0);
}

TEST(LoadScene, NormalisesRotationsAndSurvivesZeroOnes) {
    GltfBuilder file = triangle_file();
    file.root["nodes"][0]["rotation"] = {0, 0, 5, 5};
    expect_near(world_positions(load(file))[1], {0, 1, 0});
    file.root["nodes"][0]["rotation"] = {0, 0, 0, 0};
    expect_near(world_positions(load(file))[1], {1, 0, 0});
}

TEST(LoadScene, SharesTheMeshesOfInstances) {
    GltfBuilder file = triangle_file();
    file.add_node({{"mesh", 0}, {"translation", {5, 0, 0}}});
    const Scene scene = load(file);
    EXPECT_EQ(scene.meshes.size(), 1u);
    ASSERT_EQ(scene.instances.size(), 2u);
    expect_near(world_positions(scene, 1)[0], {5, 0, 0});
}

TEST(LoadScene, DrawsOnlyTheDefaultScene) {
    GltfBuilder file = triangle_file();
    file.add("nodes", {{"mesh", 0}, {"translation", {1, 0, 0}}});
    file.root["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
    file.root["scene"] = 1;
    expect_near(world_positions(load(file))[0], {1, 0, 0});
    file.root.erase("scene");
    expect_near(world_positions(load(file))[0], {0, 0, 0});
    file.root.erase("scenes");
    EXPECT_EQ(load(file).instances.size(), 2u);
}

TEST(LoadScene, ReadsDeepHierarchies) {
    GltfBuilder file = triangle_file();
    constexpr int kDepth = 50000;
    file.root["nodes"] = json::array();
    for (int n = 0; n < kDepth; ++n) {
        json node = {{"translation", {1, 0, 0}}};
        if (n + 1 < kDepth) node["children"] = {n + 1};
        if (n + 1 == kDepth) node["mesh"] = 0;
        file.root["nodes"].push_back(node);
    }
    expect_near(world_positions(load(file))[0], {kDepth, 0, 0});
}

struct TypedPositions {
    const char* name;
    int component_type;
    bool normalized;
    Blob bytes;
    double expected_x;  // of the second vertex
};

std::vector<TypedPositions> typed_positions() {
    const auto triangle = [](auto one) {
        using T = decltype(one);
        return bytes_of(std::vector<T>{0, 0, 0, 0, one, 0, 0, 0, 0, one, 0, 0});
    };
    return {
        {"byte", kByte, false, triangle(std::int8_t{-7}), -7},
        {"unsigned byte", kUnsignedByte, false, triangle(std::uint8_t{200}), 200},
        {"short", kShort, false, triangle(std::int16_t{-300}), -300},
        {"unsigned short", kUnsignedShort, false, triangle(std::uint16_t{65535}), 65535},
        {"unsigned int", kUnsignedInt, false, triangle(std::uint32_t{1} << 31), 2147483648.0},
        {"float", kFloat, false, triangle(0.25f), 0.25},
        {"normalized byte", kByte, true, triangle(std::int8_t{-128}), -1},
        {"normalized unsigned byte", kUnsignedByte, true, triangle(std::uint8_t{51}), 0.2},
        {"normalized short", kShort, true, triangle(std::int16_t{-32767}), -1},
        {"normalized unsigned short", kUnsignedShort, true, triangle(std::uint16_t{13107}), 0.2}};
}

TEST(LoadScene, ReadsAllComponentTypes) {
    for (const TypedPositions& typed : typed_positions()) {
        GltfBuilder file = triangle_file();
        // x comes second: a stride of four components whose last one is padding.
        const std::size_t stride = typed.bytes.size() / 3;
        Layout layout{typed.component_type, "VEC3", 3, typed.normalized, stride};
        if (stride % 4 != 0) layout.stride = 0;
        file.primitive()["attributes"]["POSITION"] = file.add_accessor(typed.bytes, layout);
        const auto positions = world_positions(load(file));
        EXPECT_NEAR(positions[1].x, typed.expected_x, 1e-7 * std::abs(typed.expected_x))
            << typed.name;
    }
}

TEST(LoadScene, ReadsInterleavedAttributes) {
    GltfBuilder file = triangle_file();
    const int view = file.add_view(bytes_of<float>({0, 0, 0, 0, 1, 0,  //
                                                    2, 0, 0, 0, 1, 0,  //
                                                    0, 0, 2, 0, 1, 0}),
                                   24);
    const json accessor = {
        {"bufferView", view}, {"componentType", kFloat}, {"type", "VEC3"}, {"count", 3}};
    json normal = accessor;
    normal["byteOffset"] = 12;
    file.primitive()["attributes"] = {{"POSITION", file.add("accessors", accessor)},
                                      {"NORMAL", file.add("accessors", normal)}};
    const Scene scene = load(file);
    expect_near(world_positions(scene)[2], {0, 0, 2});
    expect_near(glm::dvec3(scene.meshes[0].normals[2]), {0, 1, 0});
}

TEST(LoadScene, ReadsSparseAccessorsWithAndWithoutABase) {
    for (const bool has_base : {true, false}) {
        GltfBuilder file = triangle_file();
        const int indices = file.add_view(bytes_of<std::uint8_t>({1, 2}));
        const int values = file.add_view(bytes_of<float>({4, 5, 6, 7, 8, 9}));
        json& accessor = file.root["accessors"][0];
        if (!has_base) accessor.erase("bufferView");
        accessor["sparse"] = {
            {"count", 2},
            {"indices", {{"bufferView", indices}, {"componentType", kUnsignedByte}}},
            {"values", {{"bufferView", values}}}};
        const auto positions = world_positions(load(file));
        expect_near(positions[0], {0, 0, 0});
        expect_near(positions[1], {4, 5, 6});
        expect_near(positions[2], {7, 8, 9});
    }
}

// Triangles of five vertices as index triples.
std::vector<std::uint32_t> triangles_of_mode(int mode, bool indexed) {
    GltfBuilder file = triangle_file();
    const std::vector<float> points = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 2, 0, 3, 3, 0};
    const std::vector<float> normals = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    file.primitive()["attributes"] = {{"POSITION", file.add_floats("VEC3", points)},
                                      {"NORMAL", file.add_floats("VEC3", normals)}};
    file.primitive()["mode"] = mode;
    if (indexed) file.primitive()["indices"] = file.add_indices({0, 1, 2, 3, 4, 5});
    return load(file).meshes.at(0).indices;
}

TEST(LoadScene, ExpandsListsStripsAndFans) {
    using Indices = std::vector<std::uint32_t>;
    for (const bool indexed : {false, true}) {
        EXPECT_EQ(triangles_of_mode(4, indexed), (Indices{0, 1, 2, 3, 4, 5}));
        EXPECT_EQ(triangles_of_mode(5, indexed), (Indices{0, 1, 2, 1, 3, 2, 2, 3, 4, 3, 5, 4}));
        EXPECT_EQ(triangles_of_mode(6, indexed), (Indices{1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5, 0}));
    }
}

TEST(LoadScene, LeavesOutTrianglesThatNameAVertexTwice) {
    GltfBuilder file = triangle_file();
    file.primitive()["indices"] = file.add_indices({0, 0, 1, 0, 1, 2, 2, 1, 2});
    EXPECT_EQ(load(file).meshes[0].indices, (std::vector<std::uint32_t>{0, 1, 2}));
    file.primitive()["indices"] = file.add_indices({0, 0, 1});
    EXPECT_TRUE(load(file).instances.empty());
}

TEST(LoadScene, KeepsOnlyTheVerticesThatTrianglesUse) {
    GltfBuilder file = triangle_file();
    std::vector<float> points(3000, 0.0f);
    points[3 * 997] = 1.0f;
    points[3 * 999 + 1] = 1.0f;
    file.primitive()["attributes"] = {{"POSITION", file.add_floats("VEC3", points)},
                                      {"NORMAL", file.add_floats("VEC3", points)}};
    file.primitive()["indices"] = file.add_indices({999, 5, 997});
    const Scene scene = load(file);
    EXPECT_EQ(scene_defect(scene), "");
    EXPECT_EQ(scene.meshes[0].positions.size(), 3u);
    EXPECT_EQ(scene.meshes[0].indices, (std::vector<std::uint32_t>{2, 0, 1}));
    expect_near(world_positions(scene)[2], {0, 1, 0});
}

TEST(LoadScene, ReadsVertexColoursOfAllTypes) {
    const auto color_of = [](const Blob& bytes, const Layout& layout) {
        GltfBuilder file = triangle_file();
        file.primitive()["attributes"]["COLOR_0"] = file.add_accessor(bytes, layout);
        return load(file).meshes[0].colors.at(1);
    };
    const auto floats = bytes_of<float>({0, 0, 0, 0.2f, 0.4f, 0.6f, 0, 0, 0});
    EXPECT_EQ(color_of(floats, {kFloat, "VEC3", 3, false, 0}), glm::vec4(0.2f, 0.4f, 0.6f, 1));
    const auto shorts = bytes_of<std::uint16_t>({0, 0, 0, 0, 65535, 0, 13107, 0, 0, 0, 0, 0});
    EXPECT_EQ(color_of(shorts, {kUnsignedShort, "VEC4", 3, true, 0}), glm::vec4(1, 0, 0.2f, 0));
    const auto bytes = bytes_of<std::uint8_t>({0, 0, 0, 0, 0, 51, 255, 51, 0, 0, 0, 0});
    // Declared as plain integers by mistake, as some writers do.
    EXPECT_EQ(color_of(bytes, {kUnsignedByte, "VEC4", 3, false, 0}), glm::vec4(0, 0.2f, 1, 0.2f));
}

TEST(LoadScene, NamesTheSceneAndItsMeshes) {
    GltfBuilder file = triangle_file();
    file.root["meshes"][0]["name"] = "wedge";
    const Scene scene = load(file);
    EXPECT_EQ(scene.name, "scene");
    EXPECT_EQ(scene.meshes[0].name, "wedge");
}

}  // namespace
}  // namespace kilolux
