// SPDX-License-Identifier: Apache-2.0
// EXT_mesh_gpu_instancing: transforms in accessors.
#include <gtest/gtest.h>

#include <cmath>

#include "host/scene/gltf/load_scene.h"
#include "tests/scene/expect_near.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

using nlohmann::json;

// A triangle's file; node 0 is moved by (0, 0, 5) and drawn by the instances of `attributes`.
GltfBuilder instanced_file(const json& attributes) {
    GltfBuilder file = triangle_file();
    file.root["nodes"][0]["translation"] = {0, 0, 5};
    file.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = attributes;
    file.root["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    return file;
}

// The vertex (1, 0, 0) scaled, turned by 90 degrees about z, shifted, and then moved by the node.
TEST(LoadSceneInstancing, ScalesThenTurnsThenShiftsThenTakesTheNodesPlace) {
    const float half = std::sqrt(0.5f);
    GltfBuilder file = instanced_file(json::object());
    json& attributes = file.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    attributes["TRANSLATION"] = file.add_floats("VEC3", {10, 0, 0, 20, 0, 0});
    attributes["ROTATION"] = file.add_floats("VEC4", {0, 0, half, half, 0, 0, 0, 1});
    attributes["SCALE"] = file.add_floats("VEC3", {3, 1, 1, 1, 7, 1});
    attributes["_ID"] = file.add_floats("SCALAR", {0, 1});
    const Scene scene = load(file);
    EXPECT_EQ(scene.meshes.size(), 1u) << "instances share the mesh";
    ASSERT_EQ(scene.instances.size(), 2u) << "and the node itself is not drawn";
    expect_near(world_positions(scene, 0)[1], {10, 3, 5}, 1e-6);
    expect_near(world_positions(scene, 1)[2], {20, 7, 5}, 1e-6);
}

TEST(LoadSceneInstancing, RotationsMayBeNormalizedIntegers) {
    const double half = std::sqrt(0.5);
    for (const int type : {kByte, kShort}) {
        const double unit = type == kByte ? 127.0 : 32767.0;
        const auto q = static_cast<int>(std::lround(half * unit));
        GltfBuilder file = instanced_file(json::object());
        const Blob bytes = type == kByte
                               ? bytes_of<std::int8_t>({0, 0, static_cast<std::int8_t>(q),
                                                        static_cast<std::int8_t>(q)})
                               : bytes_of<std::int16_t>({0, 0, static_cast<std::int16_t>(q),
                                                         static_cast<std::int16_t>(q)});
        file.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["ROTATION"] =
            file.add_accessor(bytes, {type, "VEC4", 1, true, 0});
        expect_near(world_positions(load(file))[1], {0, 1, 5}, 1e-6);
    }
}

TEST(LoadSceneInstancing, NoInstancesDrawNothing) {
    GltfBuilder file = instanced_file(json::object());
    file.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["SCALE"] =
        file.add("accessors", {{"componentType", kFloat}, {"type", "VEC3"}, {"count", 0}});
    EXPECT_TRUE(load(file).instances.empty());
}

TEST(LoadSceneInstancing, RefusesAttributesThatDoNotFit) {
    const auto error_of = [](const auto& change) {
        GltfBuilder file = instanced_file(json::object());
        change(file, file.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]);
        return load_error(file);
    };
    const std::string place = "nodes[0]: EXT_mesh_gpu_instancing";
    std::string error = error_of([](GltfBuilder& file, json& extension) {
        extension["attributes"]["TRANSLATION"] = file.add_floats("VEC3", {1, 2, 3, 4, 5, 6});
        extension["attributes"]["SCALE"] = file.add_floats("VEC3", {1, 2, 3});
    });
    EXPECT_TRUE(contains(error, place + ".SCALE: has 1 instances, the attributes before it have 2"))
        << error;
    error = error_of([](GltfBuilder& file, json& extension) {
        extension["attributes"]["ROTATION"] = file.add_floats("VEC3", {1, 2, 3});
    });
    EXPECT_TRUE(contains(error, "has 3 components")) << error;
    error = error_of([](GltfBuilder& file, json& extension) {
        extension["attributes"]["SCALE"] =
            file.add_accessor(Blob(4, 127), {kByte, "VEC3", 1, true, 4});
    });
    EXPECT_TRUE(contains(error, place + ".SCALE: componentType is 5120 normalized, must be 5126"))
        << error;
    error = error_of([](GltfBuilder&, json&) {});
    EXPECT_TRUE(contains(error, place + ": has none of TRANSLATION, ROTATION and SCALE")) << error;
    error = error_of([](GltfBuilder&, json& extension) { extension = json::object(); });
    EXPECT_TRUE(contains(error, "EXT_mesh_gpu_instancing.attributes is missing")) << error;
    error = error_of([](GltfBuilder&, json& extension) { extension["attributes"]["SCALE"] = 9; });
    EXPECT_TRUE(contains(error, "\"SCALE\" is 9, must be an index into the 2 accessors")) << error;
    error = error_of([](GltfBuilder& file, json& extension) {
        extension["attributes"]["SCALE"] = file.add(
            "accessors", {{"componentType", kFloat}, {"type", "VEC3"}, {"count", 4000000000}});
    });
    EXPECT_TRUE(contains(error, "claims 4000000000 elements")) << error;
}

}  // namespace
}  // namespace kilolux
