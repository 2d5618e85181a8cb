// SPDX-License-Identifier: Apache-2.0
// Points and lines, which become solids.
#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "host/scene/animated_scene.h"
#include "tests/scene/export_scenes.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

using nlohmann::json;

constexpr int kPoints = 0;
constexpr int kLines = 1;
constexpr int kLineLoop = 2;
constexpr int kLineStrip = 3;
constexpr double kRounding = 1e-4;  // of float32 positions, relative to a width of 1/100

// Four vertices at the corners of a unit square.
GltfBuilder square(int mode) {
    GltfBuilder file;
    const int positions = file.add_floats("VEC3", {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    file.add("meshes",
             {{"primitives", {{{"attributes", {{"POSITION", positions}}}, {"mode", mode}}}}});
    file.add_node({{"mesh", 0}});
    return file;
}

LoadOptions with_width(double metres) {
    LoadOptions options;
    options.line_width = {metres, true};
    return options;
}

glm::dvec3 corner(const Mesh& mesh, std::size_t index) {
    return glm::dvec3(mesh.positions.at(mesh.indices.at(index)));
}

double surface_area(const Mesh& mesh) {
    double area = 0.0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const glm::dvec3 a = corner(mesh, i);
        area += 0.5 * glm::length(glm::cross(corner(mesh, i + 1) - a, corner(mesh, i + 2) - a));
    }
    return area;
}

// Volume within the triangles; negative where they face inwards (divergence theorem).
double volume(const Mesh& mesh) {
    double six = 0.0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        six += glm::dot(corner(mesh, i), glm::cross(corner(mesh, i + 1), corner(mesh, i + 2)));
    }
    return six / 6.0;
}

// Whether every edge occurs once in each direction.
bool is_closed(const Mesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
        const std::uint32_t a = mesh.indices[i];
        const std::uint32_t b = mesh.indices[next];
        ++edges[{a, b}];
        --edges[{b, a}];
    }
    return std::all_of(edges.begin(), edges.end(), [](const auto& e) { return e.second == 0; });
}

TEST(LoadSceneLines, EveryModeHasItsElements) {
    const std::map<int, std::size_t> elements = {
        {kPoints, 4}, {kLines, 2}, {kLineLoop, 4}, {kLineStrip, 3}};
    for (const auto& [mode, count] : elements) {
        const Scene scene = load(square(mode));
        EXPECT_EQ(scene_defect(scene), "");
        EXPECT_EQ(triangle_count(scene), 8 * count) << mode;
        GltfBuilder indexed = square(mode);
        indexed.primitive()["indices"] = indexed.add_indices({2, 3});
        const std::size_t expected = mode == kPoints || mode == kLineLoop ? 2 : 1;
        EXPECT_EQ(triangle_count(load(indexed)), 8 * expected) << mode;
        indexed.primitive()["indices"] = indexed.add_indices({2});
        EXPECT_EQ(triangle_count(load(indexed)), mode == kPoints ? 8u : 0u) << mode;
    }
}

// The loop's last segment leads back: a quarter of the vertices lie on each side of the square.
TEST(LoadSceneLines, ALoopIsClosedAndAStripIsNot) {
    for (const int mode : {kLineLoop, kLineStrip}) {
        const Mesh mesh = load(square(mode), with_width(0.001)).meshes.at(0);
        bool left_side = false;
        for (std::size_t v = 0; v + 5 < mesh.positions.size(); v += 6) {
            left_side |= mesh.positions[v].x < 0.01f && mesh.positions[v + 3].x < 0.01f;
        }
        EXPECT_EQ(left_side, mode == kLineLoop);
    }
}

// Cauchy's formula for convex bodies: the mean outline's area is a quarter of the surface's.
TEST(LoadSceneLines, ASolidsMeanWidthIsTheOneAskedFor) {
    GltfBuilder file = square(kPoints);
    file.primitive()["indices"] = file.add_indices({0});
    const Mesh point = load(file, with_width(0.01)).meshes.at(0);
    EXPECT_NEAR(surface_area(point) / 4.0 / (0.01 * 0.01), 1.0, kRounding);
    file = square(kLines);
    file.primitive()["indices"] = file.add_indices({0, 2});
    const Mesh line = load(file, with_width(0.01)).meshes.at(0);
    // Three sides of the diagonal's length; two caps, each a third of side^2 * sqrt(3) / 4.
    const double side = std::numbers::pi * 0.01 / 3.0;
    const double caps = 2.0 * std::numbers::sqrt3 / 4.0 * side * side;
    const double outline = (surface_area(line) - caps) / std::numbers::sqrt2;
    EXPECT_NEAR(outline / std::numbers::pi / 0.01, 1.0, kRounding);
}

TEST(LoadSceneLines, SolidsAreClosedAndLookOutwards) {
    for (const int mode : {kPoints, kLines, kLineLoop}) {
        const Mesh mesh = load(square(mode), with_width(0.01)).meshes.at(0);
        EXPECT_TRUE(is_closed(mesh)) << mode;
        EXPECT_GT(volume(mesh), 0.0) << mode;
        for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
            const glm::dvec3 a = corner(mesh, t);
            const glm::dvec3 way = glm::cross(corner(mesh, t + 1) - a, corner(mesh, t + 2) - a);
            const glm::dvec3 normal(mesh.normals[mesh.indices[t]] +
                                    mesh.normals[mesh.indices[t + 1]] +
                                    mesh.normals[mesh.indices[t + 2]]);
            const bool is_cap = glm::length(normal) < 0.1;
            EXPECT_TRUE(is_cap || glm::dot(way, normal) > 0.0) << mode << " " << t;
        }
    }
}

TEST(LoadSceneLines, TheWidthIsAShareOfTheSceneOrMetres) {
    GltfBuilder file = square(kLines);
    file.root["nodes"][0]["scale"] = {10, 10, 10};
    const auto thickness = [&](const LineWidth& width) {
        LoadOptions options;
        options.line_width = width;
        const Scene scene = load(file, options);
        return bounds(scene).size().z;
    };
    EXPECT_NEAR(thickness({0.04, true}) / thickness({0.02, true}), 2.0, 1e-3);
    // The square's diagonal is 10 sqrt(2) m once it is scaled.
    const double diagonal = 10.0 * std::numbers::sqrt2;
    EXPECT_NEAR(thickness({0.01, false}) / thickness({0.01 * diagonal, true}), 1.0, 1e-3);
    EXPECT_NEAR(thickness({}) / thickness({0.002 * diagonal, true}), 1.0, 1e-3);
    EXPECT_GT(thickness({0.02, true}), 0.015) << "metres of the world, not of the node";
    EXPECT_LT(thickness({0.02, true}), 0.025);
}

TEST(LoadSceneLines, ALoneVertexHasAWidthToo) {
    GltfBuilder file = square(kPoints);
    file.primitive()["indices"] = file.add_indices({0});
    EXPECT_NEAR(surface_area(load(file).meshes.at(0)), 16e-6, 1e-9) << "2/1000 of a metre";
}

TEST(LoadSceneLines, WithoutNormalsTheyShowTheirColour) {
    GltfBuilder file = square(kLines);
    file.add("materials", {{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 0, 1}}}},
                           {"emissiveFactor", {0.25, 0, 1}}});
    file.primitive()["material"] = 0;
    const Scene scene = load(file);
    ASSERT_EQ(scene.materials.size(), 2u);
    EXPECT_EQ(scene.meshes.at(0).material, 1);
    EXPECT_TRUE(scene.materials[1].unlit);
    EXPECT_EQ(scene.materials[1].base_color, glm::vec4(0.75f, 0.25f, 1.0f, 1.0f));
    EXPECT_FALSE(scene.materials[0].unlit) << "surfaces keep it";
    const Scene plain = load(square(kPoints));
    EXPECT_TRUE(plain.materials.at(0).unlit);
    EXPECT_EQ(plain.meshes.at(0).material, 0);
}

TEST(LoadSceneLines, WithNormalsTheyAreLitByThem) {
    GltfBuilder file = square(kLines);
    file.primitive()["attributes"]["NORMAL"] =
        file.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1, 0});
    file.add("materials", json::object());
    file.primitive()["material"] = 0;
    const Scene scene = load(file);
    EXPECT_EQ(scene.materials.size(), 1u);
    const Mesh& mesh = scene.meshes.at(0);
    for (std::size_t v = 0; v < 12; ++v) {
        EXPECT_EQ(mesh.normals.at(v), v < 6 ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0));
    }
}

TEST(LoadSceneLines, ANormalMapNeedsTangents) {
    GltfBuilder file = quad_with_normal_map();
    file.primitive()["mode"] = kLines;
    const Scene bare = load(file);
    EXPECT_FALSE(bare.materials.at(1).normal_texture.present());
    EXPECT_FALSE(bare.materials.at(1).unlit);
    EXPECT_TRUE(bare.meshes.at(0).tangents.empty());
    file.primitive()["attributes"]["TANGENT"] =
        file.add_floats("VEC4", {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1});
    const Scene bumpy = load(file);
    EXPECT_EQ(bumpy.meshes.at(0).material, 0);
    EXPECT_EQ(scene_defect(bumpy), "");
    EXPECT_EQ(bumpy.meshes.at(0).tangents.at(5), glm::vec4(1, 0, 0, 1));
}

TEST(LoadSceneLines, VertexColoursAndTexcoordsStay) {
    GltfBuilder file = square(kLineStrip);
    file.primitive()["attributes"]["COLOR_0"] =
        file.add_floats("VEC3", {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1});
    file.primitive()["attributes"]["TEXCOORD_0"] =
        file.add_floats("VEC2", {0, 0, 1, 0, 2, 0, 3, 0});
    const Mesh mesh = load(file).meshes.at(0);
    for (std::size_t v = 0; v < 6; ++v) {
        const glm::vec4 color = v < 3 ? glm::vec4(1, 0, 0, 1) : glm::vec4(0, 1, 0, 1);
        EXPECT_EQ(mesh.colors.at(v), color);
        EXPECT_EQ(mesh.texcoords[0].at(v), glm::vec2(v < 3 ? 0 : 1, 0));
    }
}

// The strip morphs and moves; a mesh of a triangle stands by.
GltfBuilder moving_lines() {
    GltfBuilder file = triangle_file();
    const int positions = file.add_floats("VEC3", {0, 0, 0, 1, 0, 0, 1, 1, 0});
    const int delta = file.add_floats("VEC3", {0, 0, 4, 0, 0, 4, 0, 0, 4});
    file.add("meshes", {{"primitives",
                         {{{"attributes", {{"POSITION", positions}}},
                           {"targets", {{{"POSITION", delta}}}},
                           {"mode", kLineStrip}}}}});
    const int node = file.add_node({{"mesh", 1}});
    const int input = file.add_floats("SCALAR", {0, 1});
    const int weights = file.add_floats("SCALAR", {0, 1});
    file.add("animations",
             {{"samplers", {{{"input", input}, {"output", weights}}}},
              {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", "weights"}}}}}}});
    return file;
}

TEST(LoadSceneLines, FollowMorphTargetsWithTheWidthThatTheyHadFirst) {
    const TempFolder folder;
    const auto path = folder.path() / "moving.gltf";
    write_file(path, moving_lines().gltf());
    AnimatedScene scene(path, {});
    const double area = surface_area(scene.scene().meshes.at(1));
    scene.set_time(1.0);
    EXPECT_NEAR(world_positions(scene.scene(), 1).at(0).z, 4.0, 0.01);
    EXPECT_NEAR(surface_area(scene.scene().meshes.at(1)) / area, 1.0, kRounding);
    EXPECT_EQ(scene_difference(scene.scene(), load_scene(path, {1.0})), "");
}

TEST(LoadSceneLines, ANoteSaysHowManyAndHowWide) {
    testing::internal::CaptureStderr();
    load(square(kLineLoop), with_width(0.02));
    const std::string note = testing::internal::GetCapturedStderr();
    EXPECT_TRUE(contains(note,
                         "scene.gltf: 4 points and lines are drawn as solids 0.02 m wide "
                         "(--line-width)\n"))
        << note;
}

}  // namespace
}  // namespace kilolux
