// SPDX-License-Identifier: Apache-2.0
// A scene set from time to time equals the one loaded at each time.
#include "host/scene/animated_scene.h"

#include <draco/compression/decode.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>

#include "host/base/error.h"
#include "host/scene/generated/scenes.h"
#include "tests/scene/expect_near.h"
#include "tests/scene/export_scenes.h"
#include "tests/support/box_scene.h"
#include "tests/support/gltf_compressed.h"

namespace kilolux {

// The linker gives calls of Draco's decoder to the second and those of the first to the decoder
// (tests/CMakeLists.txt). A member function is called as a function of `this`.
using DracoMesh = draco::StatusOr<std::unique_ptr<draco::Mesh>>;
DracoMesh real_decode(draco::Decoder* decoder, draco::DecoderBuffer* buffer) asm(
    "__real__ZN5draco7Decoder20DecodeMeshFromBufferEPNS_13DecoderBufferE");
DracoMesh counted_decode(draco::Decoder* decoder, draco::DecoderBuffer* buffer) asm(
    "__wrap__ZN5draco7Decoder20DecodeMeshFromBufferEPNS_13DecoderBufferE");

static std::atomic<int> draco_decodes = 0;

DracoMesh counted_decode(draco::Decoder* decoder, draco::DecoderBuffer* buffer) {
    ++draco_decodes;
    return real_decode(decoder, buffer);
}

namespace {

using nlohmann::json;

json channel(int sampler, int node, const char* path) {
    return {{"sampler", sampler}, {"target", {{"node", node}, {"path", path}}}};
}

// Node 0: a triangle with a skin whose second joint moves; 3: a triangle that morphs; 4: one that
// stands still, placed twice; 5 carries a light and a camera along.
GltfBuilder moving_file() {
    GltfBuilder file = triangle_file();
    json still = file.root["meshes"][0];
    json morphing = still;
    morphing["primitives"][0]["targets"] = {
        {{"POSITION", file.add_floats("VEC3", {0, 0, 8, 0, 0, 8, 0, 0, 8})}}};
    const Blob joints = {0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0};
    json& skinned = file.primitive()["attributes"];
    skinned["JOINTS_0"] = file.add_accessor(joints, {kUnsignedByte, "VEC4", 3, false, 0});
    skinned["WEIGHTS_0"] = file.add_floats("VEC4", {1, 0, 0, 0, 2, 2, 0, 0, 1, 0, 0, 0});
    file.add("skins", {{"joints", {1, 2}}});
    file.root["nodes"][0] = {{"mesh", 0}, {"skin", 0}};
    file.add_node({{"translation", {0, 0, 0}}});
    file.add_node({{"translation", {0, 0, 3}}});
    file.add("meshes", morphing);
    file.add("meshes", still);
    file.add_node({{"mesh", 1}});
    file.add_node({{"mesh", 2}});
    file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}});
    file.root["extensionsUsed"] = {"KHR_lights_punctual"};
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    file.add_node({{"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    file.add_node({{"mesh", 2}, {"translation", {5, 0, 0}}});
    const int input = file.add_floats("SCALAR", {0, 1, 4});
    const int path = file.add_floats("VEC3", {0, 0, 0, 2, 1, 0, 2, 9, 0});
    const int weights = file.add_floats("SCALAR", {0, 1, 0.25f});
    file.add(
        "animations",
        {{"samplers",
          {{{"input", input}, {"output", path}}, {{"input", input}, {"output", weights}}}},
         {"channels",
          {channel(0, 2, "translation"), channel(1, 3, "weights"), channel(0, 5, "translation")}}});
    return file;
}

TEST(AnimatedScene, IsWhatLoadingAtEachTimeGives) {
    const TempFolder folder;
    const auto path = folder.path() / "moving.gltf";
    write_file(path, moving_file().gltf());
    AnimatedScene scene(path, {0.5});
    EXPECT_TRUE(scene.moves());
    for (const double time : {0.5, 0.0, 1.0, 3.5, 0.25, 99.0, 0.0}) {
        scene.set_time(time);
        EXPECT_EQ(scene_defect(scene.scene()), "") << time;
        EXPECT_EQ(scene_difference(scene.scene(), load_scene(path, {time})), "") << time;
    }
    EXPECT_NE(scene_difference(load_scene(path, {0.5}), load_scene(path, {1.0})), "");
}

// Two quads with a normal map that meet in an edge, whose u runs along +x and along (1, -1, 0). The
// edge's vertices are given twice; those of the second quad are `offset` along z from those of the
// first, and a morph target moves the second quad by `way` along z from second 0 to 1.
GltfBuilder two_quads_with_normal_map(float offset, float way) {
    GltfBuilder file = quad_with_normal_map();
    const float o = offset;
    json& primitive = file.primitive();
    primitive["attributes"] = {
        {"POSITION", file.add_floats("VEC3", {0, 0, 0, 1, 0, 0, 1,  1, 0, 0,  1, 0,
                                              0, 0, o, 0, 1, o, -1, 1, o, -1, 0, o})},
        {"NORMAL", file.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1,
                                            0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1})},
        {"TEXCOORD_0",
         file.add_floats("VEC2", {0, 1, 1, 1, 1, 0, 0, 0, 0, 1, 0, 0, -1, 1, -1, 2})}};
    primitive["indices"] = file.add_indices({0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7});
    primitive["targets"] = {
        {{"POSITION", file.add_floats("VEC3", {0, 0, 0,   0, 0, 0,   0, 0, 0,   0, 0, 0,
                                               0, 0, way, 0, 0, way, 0, 0, way, 0, 0, way})}}};
    const int input = file.add_floats("SCALAR", {0, 1});
    const int output = file.add_floats("SCALAR", {0, 1});
    file.add("animations", {{"samplers", {{{"input", input}, {"output", output}}}},
                            {"channels", {channel(0, 0, "weights")}}});
    return file;
}

const float kMeanX = std::cos(std::numbers::pi_v<float> / 8);  // of the directions of both quads

// Vertices share a tangent where they are equal at rest.
TEST(AnimatedScene, VerticesShareATangentAtAllTimesOrAtNone) {
    const struct {
        float offset, way;
        bool shared;
    } cases[] = {{0, 0, true}, {0, 2, true}, {2, -2, false}};
    const TempFolder folder;
    const auto path = folder.path() / "q.glb";
    for (const auto& c : cases) {
        write_file(path, two_quads_with_normal_map(c.offset, c.way).glb());
        AnimatedScene scene(path, {});
        for (const double time : {0.0, 1.0, 0.5, 0.0}) {
            scene.set_time(time);
            const std::vector<glm::vec4>& tangents = scene.scene().meshes.at(0).tangents;
            EXPECT_EQ(tangents.at(0) == tangents.at(4), c.shared) << c.offset << " at " << time;
            EXPECT_NEAR(tangents[0].x, c.shared ? kMeanX : 1.0f, 1e-6f);
            EXPECT_EQ(scene_difference(scene.scene(), load_scene(path, {time})), "") << time;
        }
    }
}

// The quads, carried by one joint.
Mesh skinned_quads(const glm::vec3& scale) {
    GltfBuilder file = two_quads_with_normal_map(0, 0);
    json& primitive = file.primitive();
    primitive.erase("targets");
    file.root.erase("animations");
    primitive["attributes"]["JOINTS_0"] =
        file.add_accessor(Blob(4 * 8, 0), {kUnsignedByte, "VEC4", 8, false, 0});
    std::vector<float> weights(4 * 8, 0.0f);
    for (std::size_t v = 0; v < 8; ++v) weights[4 * v] = 1.0f;
    primitive["attributes"]["WEIGHTS_0"] = file.add_floats("VEC4", weights);
    file.root["nodes"][0]["skin"] = 0;
    const int joint = file.add_node({{"scale", {scale.x, scale.y, scale.z}}});
    file.add("skins", {{"joints", {joint}}});
    return load(file).meshes.at(0);
}

TEST(AnimatedScene, ASkinCarriesTheTangentsOfTheRestPose) {
    const glm::vec3 rest(kMeanX, -std::sqrt(1.0f - kMeanX * kMeanX), 0.0f);
    const Mesh mesh = skinned_quads({1, 4, 1});
    expect_near(glm::vec3(mesh.tangents.at(0)), glm::normalize(rest * glm::vec3(1, 4, 1)));
}

TEST(AnimatedScene, ASkinThatMirrorsKeepsTheImagesUp) {
    for (const float side : {1.0f, -1.0f}) {
        const Mesh mesh = skinned_quads({side, 1, 1});
        const glm::vec4 tangent = mesh.tangents.at(1);
        expect_near(glm::vec3(tangent), {side, 0, 0});
        expect_near(glm::cross(mesh.normals.at(1), glm::vec3(tangent)) * tangent.w, {0, 1, 0});
    }
}

TEST(AnimatedScene, RevisionsSayWhatChanged) {
    const TempFolder folder;
    write_file(folder.path() / "m.glb", moving_file().glb());
    AnimatedScene scene(folder.path() / "m.glb", {});
    ASSERT_EQ(scene.scene().meshes.size(), 3u);
    const SceneRevisions before = scene.scene().revisions;
    scene.set_time(0.0);
    EXPECT_EQ(scene.scene().revisions, before) << "the time is the same";
    scene.set_time(2.0);
    EXPECT_EQ(scene.scene().revisions, (SceneRevisions{1, 0, 1, 1}));
    EXPECT_EQ(scene.scene().meshes[0].revision, 1u) << "skinned";
    EXPECT_EQ(scene.scene().meshes[1].revision, 1u) << "morphed";
    EXPECT_EQ(scene.scene().meshes[2].revision, 0u) << "stands still";
}

TEST(AnimatedScene, RevisionsGrowOneByOne) {
    // Channels of moving_file() in turn, and what the node of each carries.
    const struct {
        int channel, node;
        const char* path;
        SceneRevisions expected;
    } cases[] = {
        {0, 2, "translation", {1, 0, 0, 0}},  // a joint
        {1, 3, "weights", {1, 0, 0, 0}},
        {0, 4, "translation", {0, 1, 0, 0}},  // a mesh that stands still
        {0, 5, "translation", {0, 0, 1, 1}},  // a lamp with a camera
        {0, 6, "translation", {0, 1, 0, 0}},
    };
    const TempFolder folder;
    for (const auto& c : cases) {
        GltfBuilder file = moving_file();
        file.root["animations"][0]["channels"] = {channel(c.channel, c.node, c.path)};
        write_file(folder.path() / "m.glb", file.glb());
        AnimatedScene scene(folder.path() / "m.glb", {});
        scene.set_time(1.0);
        EXPECT_EQ(scene.scene().revisions, c.expected) << "node " << c.node;
    }
}

TEST(AnimatedScene, TheStillBoxIsThatOfTheTimeAskedForAtAnyTime) {
    const TempFolder folder;
    const auto path = folder.path() / "m.gltf";
    write_file(path, moving_file().gltf());
    const Box at_zero = bounds(load_scene(path, {0.0}));
    AnimatedScene scene(path, {4.0});
    const Box asked = bounds(scene.scene());
    EXPECT_NE(asked.max, at_zero.max);
    for (const double time : {0.0, 1.0, 4.0}) {
        scene.set_time(time);
        EXPECT_EQ(resting_bounds(scene.scene()).min, asked.min) << time;
        EXPECT_EQ(resting_bounds(scene.scene()).max, asked.max) << time;
    }
}

TEST(AnimatedScene, NodesHiddenByAScaleOfZeroAreOutsideOfNoBox) {
    Scene scene;
    scene.meshes.push_back(box_mesh(glm::dvec3(2.0)));
    glm::dmat4 hidden(0.0);
    hidden[3] = {1e4, 0.0, 0.0, 1.0};
    scene.instances = {{0, glm::dmat4(1.0)}, {0, hidden}};
    EXPECT_EQ(bounds(scene).max, glm::dvec3(1.0));
    // A flat instance is not hidden.
    scene.instances[1].world_from_object[0][0] = scene.instances[1].world_from_object[1][1] = 1.0;
    EXPECT_EQ(bounds(scene).max, glm::dvec3(1e4 + 1.0, 1.0, 1.0));
}

// A bone of scale 0 and a morph target leave triangles without an area; rounding leaves specks.
TEST(AnimatedScene, TrianglesWithoutAreaAndSpecksAreOutsideOfNoBox) {
    Scene scene;
    scene.meshes.assign(2, box_mesh(glm::dvec3(2.0)));
    scene.instances = {{0, glm::dmat4(1.0)}, {1, glm::dmat4(1.0)}};
    for (const float apart : {0.0f, 1e-4f}) {
        for (std::size_t i = 0; i < scene.meshes[1].positions.size(); ++i) {
            scene.meshes[1].positions[i] = {1e4f + apart * static_cast<float>(i % 3), 0.0f, 0.0f};
        }
        EXPECT_EQ(bounds(scene).max, glm::dvec3(1.0)) << apart;
    }
    scene.meshes[1] = scene.meshes[0];
    scene.meshes[1].positions.emplace_back(1e4f, 0.0f, 0.0f);
    EXPECT_EQ(bounds(scene).max, glm::dvec3(1.0)) << "no triangle uses it";
    scene.instances[1].world_from_object = glm::dmat4(glm::dmat3(1e-6));
    scene.instances[1].world_from_object[3] = {1e4, 0.0, 0.0, 1.0};
    EXPECT_EQ(bounds(scene).max, glm::dvec3(1.0)) << "a speck";
    const glm::dmat3 turned(glm::dvec3(0.6, 0.8, 0.0), glm::dvec3(0.3, 0.4, 0.0), glm::dvec3(0.0));
    scene.instances[1].world_from_object = glm::dmat4(turned);
    scene.instances[1].world_from_object[3] = {1e4, 0.0, 0.0, 1.0};
    EXPECT_EQ(bounds(scene).max, glm::dvec3(1.0)) << "a line";
}

TEST(AnimatedScene, ThousandsOfTimesDoNotUseUpWhatAFileMayDecodeTo) {
    const TempFolder folder;
    const auto path = folder.path() / "m.glb";
    write_file(path, moving_file().glb());
    AnimatedScene scene(path, {});
    for (int i = 1; i < 3000; ++i) scene.set_time(i / 1000.0);
    EXPECT_EQ(scene_difference(scene.scene(), load_scene(path, {2.999})), "");
}

TEST(AnimatedScene, StaysAtItsTimeWhereAnotherOneFails) {
    GltfBuilder file = moving_file();
    const float odd = std::numeric_limits<float>::quiet_NaN();
    file.root["animations"][0]["samplers"][0]["output"] =
        file.add_floats("VEC3", {0, 0, 0, 2, 1, 0, 2, odd, 0});
    const TempFolder folder;
    const auto path = folder.path() / "m.glb";
    write_file(path, file.glb());
    AnimatedScene scene(path, {0.5});
    const SceneRevisions before = scene.scene().revisions;
    for (int repeat = 0; repeat < 2; ++repeat) EXPECT_THROW(scene.set_time(3.0), Error);
    EXPECT_EQ(scene.scene().revisions, before);
    EXPECT_EQ(scene_difference(scene.scene(), load_scene(path, {0.5})), "");
    scene.set_time(0.75);
    EXPECT_EQ(scene_difference(scene.scene(), load_scene(path, {0.75})), "");
}

TEST(AnimatedScene, StandsStillWithoutAnimations) {
    const TempFolder folder;
    write_file(folder.path() / "t.glb", triangle_file().glb());
    AnimatedScene file(folder.path() / "t.glb", {});
    AnimatedScene generated(make_generated_scene("plain"));
    for (AnimatedScene* scene : {&file, &generated}) {
        EXPECT_FALSE(scene->moves());
        scene->set_time(7.0);
        EXPECT_EQ(scene->scene().revisions, SceneRevisions{});
        EXPECT_EQ(scene->scene().still_box, bounds(scene->scene()));
    }
}

// A quad that morphs and one whose node moves, both compressed.
TEST(AnimatedScene, DecodesDracoOnce) {
    GltfBuilder file = draco_file(draco_quad(kDracoSequential));
    add_draco_quad(file, draco_quad(kDracoSequential));
    file.primitive()["targets"] = {
        {{"POSITION", file.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1})}}};
    const int input = file.add_floats("SCALAR", {0, 1});
    const int weights = file.add_floats("SCALAR", {0, 1});
    const int path = file.add_floats("VEC3", {0, 0, 0, 1, 0, 0});
    file.add("animations",
             {{"samplers",
               {{{"input", input}, {"output", weights}}, {{"input", input}, {"output", path}}}},
              {"channels", {channel(0, 0, "weights"), channel(1, 1, "translation")}}});
    const TempFolder folder;
    write_file(folder.path() / "quads.glb", file.glb());
    draco_decodes = 0;
    AnimatedScene scene(folder.path() / "quads.glb", {});
    EXPECT_EQ(draco_decodes, 2);
    for (const double time : {0.25, 0.5, 1.0, 0.0}) {
        scene.set_time(time);
        EXPECT_EQ(scene.scene().meshes[0].positions[0].z, static_cast<float>(time));
    }
    EXPECT_EQ(draco_decodes, 2) << "and none for a frame";
}

}  // namespace
}  // namespace kilolux
