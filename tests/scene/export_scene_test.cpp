// SPDX-License-Identifier: Apache-2.0
#include "host/scene/export/export_scene.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "host/scene/generated/scenes.h"
#include "host/scene/lights/light_generator.h"
#include "host/scene/lights/light_kinds.h"
#include "host/scene/lights/rig.h"
#include "tests/scene/export_scenes.h"
#include "tests/support/gltf_seeds.h"
#include "tests/support/paths.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

Scene round_trip(const Scene& scene, const std::string& name) {
    const TempFolder folder;
    write_export(export_scene(scene, folder.path() / name), folder.path());
    return load_scene(folder.path() / name);
}

TEST(ExportScene, KeepsEveryBitInBothForms) {
    const Scene scene = scene_of_everything();
    for (const char* name : {"all.glb", "all.gltf", "a b%20\xc3\xa4.gltf", "LOUD.GLB"}) {
        EXPECT_EQ(scene_difference(scene, round_trip(scene, name)), "") << name;
    }
}

TEST(ExportScene, KeepsGeneratedScenesWithTheirLightsAtATime) {
    for (const char* name : {"grid", "plain", "corridor"}) {
        Scene scene = make_generated_scene(name);
        LightOptions lights;
        lights.count = 100;
        scene.lights = generate_lights(lights, scene, 1.25);
        EXPECT_EQ(scene_difference(scene, round_trip(scene, "x.glb")), "") << name;
    }
}

TEST(ExportScene, KeepsWhatAFileWithEveryFeatureHolds) {
    const TempFolder folder;
    write_file(folder.path() / "all.glb", every_feature_file().glb());
    LoadOptions options;
    options.time = 0.5;
    const Scene scene = load_scene(folder.path() / "all.glb", options);
    for (const char* name : {"x.glb", "x.gltf"}) {
        Scene back = round_trip(scene, name);
        // A rotated texture transform comes back within its rounding.
        const glm::mat3& turned = scene.materials[0].normal_texture.uv_from_texcoord;
        glm::mat3& read = back.materials[0].normal_texture.uv_from_texcoord;
        for (int i = 0; i < 9; ++i) EXPECT_NEAR(read[i / 3][i % 3], turned[i / 3][i % 3], 1e-6f);
        read = turned;
        EXPECT_EQ(scene_difference(scene, back), "") << name;
    }
}

TEST(ExportScene, KeepsWhatTheLoaderMadeOfAFile) {
    const TempFolder folder;
    write_file(folder.path() / "scene.glb", converted_features_file().glb());
    LoadOptions options;
    options.variant = "b";
    const Scene scene = load_scene(folder.path() / "scene.glb", options);
    EXPECT_EQ(scene_defect(scene), "");
    EXPECT_EQ(scene.instances.size(), 3u + 4u) << "instances, and points and lines";
    // Of the quad's six indices: 6 points, 3 segments, 6 of the loop, 5 of the strip.
    EXPECT_EQ(triangle_count(scene), 3u * 2u + 8u * (6u + 3u + 6u + 5u));
    EXPECT_EQ(scene.meshes.at(0).material, 1);
    EXPECT_EQ(scene_difference(scene, round_trip(scene, "x.glb")), "");
}

// As an animation of visibility hides it for a while.
TEST(ExportScene, AnInstanceThatIsAPointIsLeftOut) {
    Scene scene = make_generated_scene("grid");
    scene.instances.back().world_from_object = glm::dmat4(glm::dmat3(0.0));
    const Scene back = round_trip(scene, "x.glb");
    scene.instances.pop_back();
    EXPECT_EQ(scene.instances, back.instances);
}

// As the export command places it.
TEST(ExportScene, ALightThatFollowsTheCameraTurnsWithIt) {
    SceneLight light;
    light.follows_camera = true;
    const glm::dmat3 quarter({0, 1, 0}, {-1, 0, 0}, {0, 0, 1});  // about +Z
    light = placed_light(light, quarter, {1, 2, 3});
    EXPECT_EQ(light.position, glm::dvec3(1, 2, 3));
    EXPECT_EQ(light.direction, glm::dvec3(0, 0, -1));
    EXPECT_EQ(light.side, glm::dvec3(0, 1, 0));
}

TEST(ExportScene, WritesOnlyConesThatTheExtensionAllows) {
    for (const auto& [inner, outer] : {std::pair{5.0f, 4.0f}, {0.5f, 0.5f}, {-1.0f, 0.5f}}) {
        Scene scene = make_generated_scene("grid");
        SceneLight spot{.intensity = glm::vec3(1), .type = LightType::spot};
        spot.inner_cone = inner;
        spot.outer_cone = outer;
        scene.lights = {spot};
        EXPECT_EQ(cone_problem(round_trip(scene, "x.glb").lights.at(0)), "");
    }
}

// glTF's factors end at 1: such a colour is written as emission, which looks the same.
TEST(ExportScene, KeepsUnlitColoursAboveOne) {
    Scene scene = scene_of_everything();
    scene.materials[0] = Material{};
    scene.materials[0].unlit = true;
    scene.materials[0].base_color = {3.0f, 0.5f, 0.0f, 1.0f};
    const Material back = round_trip(scene, "x.glb").materials[0];
    EXPECT_EQ(back.emissive, glm::vec3(3.0f, 0.5f, 0.0f));
    EXPECT_EQ(back.base_color, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
    EXPECT_EQ(back.specular, 0.0f);
}

TEST(ExportScene, KeepsRealScenes) {
    const fs::path scenes = fs::path(source_root()) / ".." / "shared" / "scenes";
    if (!fs::exists(scenes)) GTEST_SKIP() << scenes << " is not there";
    for (const char* name : {"helmet/DamagedHelmet.glb", "small/BoxMeshopt.glb",
                             "small/BoxVertexColors.glb", "small/ShapeCollection.glb"}) {
        const Scene scene = load_scene(scenes / name);
        EXPECT_EQ(scene_difference(scene, round_trip(scene, "x.glb")), "") << name;
    }
}

TEST(ExportScene, SplitsAShearThatNoNodeHolds) {
    Scene scene = scene_of_everything();
    glm::dmat4 shear = glm::scale(glm::dmat4(1.0), {2.0, 0.1, -3.0});
    shear[1].x = 0.9;
    shear[2].y = -1.7;
    shear[3] = {4.0, 5.0, 6.0, 1.0};
    scene.instances = {{0, shear}};
    const Scene back = round_trip(scene, "x.glb");
    ASSERT_EQ(back.instances.size(), 1u);
    for (int i = 0; i < 16; ++i) {
        EXPECT_NEAR(back.instances[0].world_from_object[i / 4][i % 4], shear[i / 4][i % 4], 1e-14);
    }
}

TEST(ExportScene, KeepsATurnedTextureTransformWithinItsRounding) {
    Scene scene = scene_of_everything();
    const float c = std::cos(0.7f), s = std::sin(0.7f);
    const glm::mat3 turned(glm::vec3(2.0f * c, -2.0f * s, 0.0f),
                           glm::vec3(-0.5f * s, -0.5f * c, 0.0f), glm::vec3(0.1f, 0.2f, 1.0f));
    scene.materials[0].base_color_texture.uv_from_texcoord = turned;
    const Scene back = round_trip(scene, "x.gltf");
    const glm::mat3& m = back.materials[0].base_color_texture.uv_from_texcoord;
    for (int i = 0; i < 9; ++i) EXPECT_NEAR(m[i / 3][i % 3], turned[i / 3][i % 3], 3e-7f) << i;
}

TEST(ExportScene, StepsAParallelCameraBackThatSeesBehindItself) {
    Scene scene = scene_of_everything();
    SceneCamera& camera = scene.cameras[1];
    camera.z_near = -2.5;
    const Scene back = round_trip(scene, "x.glb");
    const SceneCamera& moved = back.cameras[1];
    EXPECT_EQ(moved.z_near, 0.0);
    EXPECT_EQ(moved.z_far, 12.5);
    const glm::dvec4 step = moved.world_from_camera[3] - camera.world_from_camera[3];
    EXPECT_NEAR(glm::distance(step, 2.5 * camera.world_from_camera[2]), 0.0, 1e-14);
}

TEST(ExportScene, CountsLightsThatCannotBeSaid) {
    Scene scene = scene_of_everything();
    const std::size_t good = scene.lights.size();
    SceneLight bad = scene.lights[0];
    bad.intensity.x = -1.0f;
    scene.lights.push_back(bad);
    bad = scene.lights[0];
    bad.position.y = std::numeric_limits<double>::infinity();
    scene.lights.insert(scene.lights.begin(), bad);
    const ExportedScene exported = export_scene(scene, "x.glb");
    EXPECT_EQ(exported.lights, good);
    EXPECT_EQ(exported.unusable_lights, 2u);
}

TEST(ExportScene, AnEmptySceneIsAFileToo) {
    const Scene back = round_trip({}, "x.glb");
    EXPECT_TRUE(back.meshes.empty());
    EXPECT_TRUE(back.lights.empty());
}

}  // namespace
}  // namespace kilolux
