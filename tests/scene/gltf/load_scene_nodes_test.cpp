// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "host/scene/gltf/load_scene.h"
#include "tests/scene/expect_near.h"
#include "tests/support/gltf_builder.h"

namespace kilolux {
namespace {

using nlohmann::json;

// A file of one light on a node that is turned to shine along +X and scaled.
SceneLight light_of(const json& light, const json& scale = {2, 3, 4}) {
    GltfBuilder file;
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = {light};
    file.add_node({{"translation", {1, 2, 3}},
                   {"rotation", {0, -std::sqrt(0.5), 0, std::sqrt(0.5)}},
                   {"scale", scale},
                   {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    return load(file).lights.at(0);
}

TEST(LoadSceneLights, HaveTheDefaultsOfTheExtension) {
    const SceneLight point = light_of({{"type", "point"}});
    EXPECT_EQ(point.type, LightType::point);
    expect_near(point.position, {1, 2, 3});
    EXPECT_EQ(point.intensity, glm::vec3(1));
    EXPECT_EQ(point.range, 0.0f);
    for (const json& light :
         {json{{"type", "spot"}}, json{{"type", "spot"}, {"spot", json::object()}}}) {
        const SceneLight spot = light_of(light);
        EXPECT_EQ(spot.type, LightType::spot);
        EXPECT_EQ(spot.inner_cone, 0.0f);
        EXPECT_FLOAT_EQ(spot.outer_cone, glm::quarter_pi<float>());
    }
}

// A NaN would differ from itself, and the scene's lights would be new in every frame.
TEST(LoadSceneLights, OfAFlatNodeHaveAxes) {
    const SceneLight spot = light_of({{"type", "spot"}}, {0, 1, 1});
    expect_near(spot.direction, {1, 0, 0});
    expect_near(spot.side, {0, 0, 1});
    const SceneLight unaimed = light_of({{"type", "spot"}}, {1, 1, 0});
    EXPECT_EQ(unaimed.direction, glm::dvec3(0.0)) << "which the renderer rejects";
    EXPECT_EQ(unaimed, unaimed);
}

TEST(LoadSceneLights, ReadAllProperties) {
    const SceneLight spot =
        light_of({{"type", "spot"},
                  {"color", {1, 0.5, 0.25}},
                  {"intensity", 40},
                  {"range", 12.5},
                  {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.4}}}});
    EXPECT_EQ(spot.intensity, glm::vec3(40, 20, 10));
    EXPECT_EQ(spot.range, 12.5f);
    EXPECT_FLOAT_EQ(spot.inner_cone, 0.2f);
    EXPECT_FLOAT_EQ(spot.outer_cone, 0.4f);
    expect_near(spot.direction, {1, 0, 0});
    const SceneLight sun = light_of({{"type", "directional"}, {"intensity", 1e5}});
    EXPECT_EQ(sun.type, LightType::directional);
    expect_near(sun.direction, {1, 0, 0});
    EXPECT_EQ(sun.intensity, glm::vec3(1e5f));
}

TEST(LoadSceneLights, KeepOddValuesForTheRendererToCount) {
    const SceneLight odd = light_of({{"type", "point"}, {"intensity", -7}, {"range", -2}});
    EXPECT_EQ(odd.intensity, glm::vec3(-7));
    EXPECT_EQ(odd.range, -2.0f);
    EXPECT_TRUE(std::isinf(light_of({{"type", "point"}, {"intensity", 1e300}}).intensity.x));
}

SceneCamera camera_of_file(const json& camera) {
    GltfBuilder file;
    file.add("cameras", camera);
    file.add_node({{"camera", 0}, {"translation", {0, 0, 5}}});
    return load(file).cameras.at(0);
}

TEST(LoadSceneCameras, ReadPerspectiveOnes) {
    const SceneCamera camera = camera_of_file({{"type", "perspective"},
                                               {"name", "eye"},
                                               {"perspective", {{"yfov", 1.0}, {"znear", 0.25}}}});
    EXPECT_EQ(camera.name, "eye");
    EXPECT_FALSE(camera.orthographic);
    EXPECT_EQ(camera.y_fov, 1.0);
    EXPECT_EQ(camera.z_near, 0.25);
    EXPECT_TRUE(std::isinf(camera.z_far));
    EXPECT_EQ(camera.aspect, 0.0);
    expect_near(glm::dvec3(camera.world_from_camera[3]), {0, 0, 5});
    const SceneCamera full = camera_of_file(
        {{"type", "perspective"},
         {"perspective", {{"yfov", 1}, {"znear", 1}, {"zfar", 9}, {"aspectRatio", 1.5}}}});
    EXPECT_EQ(full.z_far, 9.0);
    EXPECT_EQ(full.aspect, 1.5);
}

TEST(LoadSceneCameras, ReadOrthographicOnes) {
    const SceneCamera camera =
        camera_of_file({{"type", "orthographic"},
                        {"orthographic", {{"xmag", 4}, {"ymag", 2}, {"znear", 0}, {"zfar", 50}}}});
    EXPECT_TRUE(camera.orthographic);
    EXPECT_EQ(camera.y_extent, 2.0);
    EXPECT_EQ(camera.aspect, 2.0);
    EXPECT_EQ(camera.z_near, 0.0);
    EXPECT_EQ(camera.z_far, 50.0);
}

TEST(LoadSceneCameras, RefuseValuesThatNoCameraHas) {
    for (const json& perspective :
         {json{{"yfov", 0}, {"znear", 1}}, json{{"yfov", 4}, {"znear", 1}},
          json{{"yfov", 1}, {"znear", 0}}, json{{"yfov", 1}, {"znear", 2}, {"zfar", 1}},
          json{{"yfov", 1}, {"znear", 1}, {"aspectRatio", -1}}, json{{"yfov", 1}}}) {
        GltfBuilder file;
        file.add("cameras", {{"type", "perspective"}, {"perspective", perspective}});
        file.add_node({{"camera", 0}});
        const std::string error = load_error(file);
        EXPECT_NE(error.find("cameras[0].perspective"), std::string::npos)
            << perspective << ": " << error;
    }
}

// The position of node 0's origin at a time, with one animated property.
glm::dvec3 animated_point(const json& sampler_part, const std::vector<float>& values, double time) {
    GltfBuilder file = triangle_file();
    json sampler = sampler_part;
    sampler["input"] = file.add_floats("SCALAR", {1, 2, 4});
    sampler["output"] = file.add_floats("VEC3", values);
    file.add(
        "animations",
        {{"samplers", {sampler}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}});
    LoadOptions options;
    options.time = time;
    return world_positions(load(file, options)).at(0);
}

TEST(LoadSceneAnimation, StepsAndBlendsAndHoldsItsEnds) {
    const std::vector<float> x = {0, 0, 0, 10, 0, 0, 30, 0, 0};
    for (const char* mode : {"LINEAR", "STEP"}) {
        const bool is_step = std::string(mode) == "STEP";
        const json sampler = {{"interpolation", mode}};
        expect_near(animated_point(sampler, x, 0.0), {0, 0, 0});
        expect_near(animated_point(sampler, x, 1.0), {0, 0, 0});
        expect_near(animated_point(sampler, x, 1.5), {is_step ? 0 : 5, 0, 0});
        expect_near(animated_point(sampler, x, 2.0), {10, 0, 0});
        expect_near(animated_point(sampler, x, 3.0), {is_step ? 10 : 20, 0, 0});
        expect_near(animated_point(sampler, x, 99.0), {30, 0, 0});
    }
    expect_near(animated_point(json::object(), x, 1.5), {5, 0, 0});
}

TEST(LoadSceneAnimation, FollowsCubicSplines) {
    // In-tangent, value, out-tangent of three keys; y is a cubic with slope 3 at t = 2.
    const std::vector<float> keys = {0, 0, 0, 0, 0, 0, 0, 0, 0,  //
                                     0, 3, 0, 0, 1, 0, 0, 3, 0,  //
                                     0, 0, 0, 0, 8, 0, 0, 0, 0};
    const json sampler = {{"interpolation", "CUBICSPLINE"}};
    expect_near(animated_point(sampler, keys, 2.0), {0, 1, 0});
    // Hermite at the middle: (v0 + v1) / 2 + length * (b0 - a1) / 8.
    expect_near(animated_point(sampler, keys, 1.5), {0, 0.5 - 3.0 / 8.0, 0});
    expect_near(animated_point(sampler, keys, 3.0), {0, 4.5 + 2.0 * 3.0 / 8.0, 0});
}

TEST(LoadSceneAnimation, TurnsAlongTheShortArc) {
    GltfBuilder file = triangle_file();
    const int input = file.add_floats("SCALAR", {0, 1});
    // No turn, then a quarter turn about z, the second as the negated quaternion.
    const float s = std::sqrt(0.5f);
    const int output = file.add_floats("VEC4", {0, 0, 0, 1, 0, 0, -s, -s});
    file.add("animations",
             {{"samplers", {{{"input", input}, {"output", output}}}},
              {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}}}}});
    LoadOptions options;
    options.time = 0.5;
    expect_near(world_positions(load(file, options)).at(1), {s, s, 0});
}

TEST(LoadSceneAnimation, RefusesOutputsThatDoNotGoWithTheKeys) {
    GltfBuilder file = triangle_file();
    const int input = file.add_floats("SCALAR", {0, 1, 2});
    const int output = file.add_floats("VEC3", {0, 0, 0, 1, 1, 1});
    json channel = {{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}};
    file.add("animations",
             {{"samplers", {{{"input", input}, {"output", output}}}}, {"channels", {channel}}});
    EXPECT_NE(load_error(file).find("animations[0].channels[0]: output has 2 values"),
              std::string::npos);
    file.root["animations"][0]["channels"][0]["sampler"] = 5;
    EXPECT_NE(load_error(file).find("sampler is 5"), std::string::npos);
}

// A triangle that two morph targets move.
GltfBuilder morphed_file() {
    GltfBuilder file = triangle_file();
    file.primitive()["targets"] = {
        {{"POSITION", file.add_floats("VEC3", {0, 0, 8, 0, 0, 8, 0, 0, 8})}},
        {{"POSITION", file.add_floats("VEC3", {0, 0, 0, 4, 0, 0, 0, 0, 0})},
         {"NORMAL", file.add_floats("VEC3", {1, 0, -1, 0, 0, 0, 0, 0, 0})}}};
    return file;
}

TEST(LoadSceneMorph, TakesWeightsFromAnimationThenNodeThenMesh) {
    GltfBuilder file = morphed_file();
    file.add_node({{"mesh", 0}});
    expect_near(world_positions(load(file))[1], {1, 0, 0});
    EXPECT_EQ(load(file).meshes.size(), 1u);
    file.root["meshes"][0]["weights"] = {0.5, 0};
    expect_near(world_positions(load(file))[1], {1, 0, 4});
    file.root["nodes"][0]["weights"] = {0, 1};
    const Scene scene = load(file);
    expect_near(world_positions(scene, 0)[1], {5, 0, 0});
    expect_near(world_positions(scene, 1)[1], {1, 0, 4});
    expect_near(glm::dvec3(scene.meshes[0].normals[0]), {1, 0, 0});
    const int input = file.add_floats("SCALAR", {0, 2});
    const int output = file.add_floats("SCALAR", {0, 0, 0.5f, 1});
    file.add("animations",
             {{"samplers", {{{"input", input}, {"output", output}}}},
              {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}});
    LoadOptions options;
    options.time = 1.0;
    expect_near(world_positions(load(file, options), 0)[1], {3, 0, 2});
}

// A triangle bound to two joints; the second vertex follows both by halves.
GltfBuilder skinned_file() {
    GltfBuilder file = triangle_file();
    const Blob joints = {0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0};
    file.primitive()["attributes"]["JOINTS_0"] =
        file.add_accessor(joints, {kUnsignedByte, "VEC4", 3, false, 0});
    file.primitive()["attributes"]["WEIGHTS_0"] =
        file.add_floats("VEC4", {1, 0, 0, 0, 2, 2, 0, 0, 1, 0, 0, 0});
    const int bind = file.add_floats("MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,  //
                                              1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1});
    file.add("skins", {{"joints", {1, 2}}, {"inverseBindMatrices", bind}});
    // The node's own place does not count once it is skinned.
    file.root["nodes"][0] = {{"mesh", 0}, {"skin", 0}, {"translation", {100, 100, 100}}};
    file.add_node({{"translation", {1e7, 0, 0}}});
    file.add_node({{"translation", {1e7, 0, 3}}, {"scale", {1, 2, 1}}});
    return file;
}

TEST(LoadSceneSkin, FollowsItsJointsAndStaysPreciseFarOut) {
    const Scene scene = load(skinned_file());
    EXPECT_EQ(scene_defect(scene), "");
    const auto positions = world_positions(scene);
    expect_near(positions[0], {1e7, 0, 0});
    // Half of joint 0 at (1e7 + 1, 0, 0) and half of joint 1 at (1e7 + 0, 0, 3).
    expect_near(positions[1], {1e7 + 0.5, 0, 1.5});
    expect_near(positions[2], {1e7 - 1, 2, 3});
}

TEST(LoadSceneSkin, RefusesJointsThatAreNotThere) {
    GltfBuilder file = skinned_file();
    file.root["skins"][0]["joints"] = {1};
    EXPECT_NE(load_error(file).find("names joint 1"), std::string::npos) << load_error(file);
    file = skinned_file();
    file.root["skins"][0]["joints"] = {1, 2, 1};
    EXPECT_NE(load_error(file).find("skins[0]: has 3 joints and 2 inverse"), std::string::npos);
    file = skinned_file();
    file.primitive()["attributes"].erase("JOINTS_0");
    EXPECT_NE(load_error(file).find("has no JOINTS_0"), std::string::npos);
}

}  // namespace
}  // namespace kilolux
