// SPDX-License-Identifier: Apache-2.0
// Defects of the loader that were reported for real files.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <filesystem>
#include <numbers>

#include "host/base/error.h"
#include "host/scene/animated_scene.h"
#include "tests/support/gltf_compressed.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Two triangles that share an edge and whose texture is mirrored there; the second has no area
// until an animation morphs it. A mesh that stands still follows.
GltfBuilder mirrored_file() {
    GltfBuilder file;
    const int map = file.add_texture(encode_image("png", 1, 3, {128, 128, 255}), "image/png");
    file.add("materials", {{"normalTexture", {{"index", map}}}});
    json& mesh = file.root["meshes"][0];
    mesh["primitives"][0] = {
        {"attributes",
         {{"POSITION", file.add_floats("VEC3", {0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0})},
          {"NORMAL", file.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1})},
          {"TEXCOORD_0", file.add_floats("VEC2", {0, 0, 0, 1, 1, 0, 1, 0})}}},
        {"indices", file.add_indices({0, 2, 1, 0, 1, 3})},
        {"material", 0},
        {"targets",
         {{{"POSITION", file.add_floats("VEC3", {0, 0, 0, 0, 0, 0, 0, 0, 0, -1, 0, 0})}}}}};
    file.add("meshes", file.root["meshes"][0]);
    file.root["meshes"][1]["primitives"][0].erase("targets");
    file.add_node({{"mesh", 0}});
    file.add_node({{"mesh", 1}});
    const int times = file.add_floats("SCALAR", {0, 1});
    const int weights = file.add_floats("SCALAR", {0, 1});
    file.add("animations",
             {{"samplers", {{{"input", times}, {"output", weights}}}},
              {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}});
    return file;
}

TEST(LoadSceneReports, AnAnimationChangesNoVertexCount) {
    const TempFolder folder;
    write_file(folder.path() / "scene.gltf", mirrored_file().gltf());
    AnimatedScene scene(folder.path() / "scene.gltf", {});
    const Mesh before = scene.scene().meshes.at(0);
    EXPECT_EQ(before.positions.size(), 6u) << "the shared edge is split";
    EXPECT_EQ(scene.scene().meshes.at(1).positions.size(), 6u);
    scene.set_time(1.0);
    const Mesh& after = scene.scene().meshes.at(0);
    EXPECT_EQ(after.positions.size(), before.positions.size());
    EXPECT_EQ(after.indices, before.indices);
    EXPECT_EQ(scene_defect(scene.scene()), "");
    for (std::size_t i = 0; i < 6; ++i) {
        const float handedness = after.tangents.at(after.indices[i]).w;
        EXPECT_EQ(handedness, i < 3 ? -1.0f : 1.0f) << "corner " << i;
    }
}

TEST(LoadSceneReports, VertexColoursEndAtOneAfterMorphing) {
    GltfBuilder file = triangle_file();
    file.primitive()["attributes"]["COLOR_0"] =
        file.add_floats("VEC4", {2, 0.5f, -1, 2, 1, 1, 1, 1, 0.25f, 0.25f, 0.25f, 0.25f});
    file.primitive()["targets"] = {
        {{"COLOR_0", file.add_floats("VEC4", {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0.5f})}}};
    file.root["meshes"][0]["weights"] = {1};
    const Scene scene = load(file);
    EXPECT_EQ(scene.meshes.at(0).colors.at(0), glm::vec4(1.0f, 0.5f, 0.0f, 1.0f));
    EXPECT_EQ(scene.meshes.at(0).colors.at(1), glm::vec4(1.0f));
    EXPECT_EQ(scene.meshes.at(0).colors.at(2), glm::vec4(0.25f, 0.25f, 0.25f, 0.75f));
}

TEST(LoadSceneReports, NodesOfOneShapeShareItsMesh) {
    GltfBuilder file = triangle_file();
    file.primitive()["targets"] = {
        {{"POSITION", file.add_floats("VEC3", {0, 0, 8, 0, 0, 8, 0, 0, 8})}}};
    file.root["meshes"][0]["weights"] = {0.5};
    for (int i = 0; i < 100; ++i) file.add_node({{"mesh", 0}, {"translation", {i, 0, 0}}});
    file.add_node({{"mesh", 0}, {"weights", {0.25}}});
    const Scene scene = load(file);
    EXPECT_EQ(scene.instances.size(), 102u);
    EXPECT_EQ(scene.meshes.size(), 2u);
    EXPECT_EQ(world_positions(scene, 100).at(0), glm::dvec3(99, 0, 4));
    EXPECT_EQ(world_positions(scene, 101).at(0).z, 2.0);
}

TEST(LoadSceneReports, ABrokenAnimationStopsOnlyThoseWhoPlayIt) {
    GltfBuilder file = triangle_file();
    const int times = file.add_accessor(Blob(4), {kFloat, "SCALAR", 900, false, 0});
    const int places = file.add_floats("VEC3", {0, 0, 0});
    file.add("animations",
             {{"samplers", {{{"input", times}, {"output", places}}}},
              {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}}});
    EXPECT_TRUE(contains(load_error(file), "accessors[2]: needs 3600 bytes"));
    LoadOptions options;
    options.clips = {"none"};
    const Scene scene = load(file, options);
    EXPECT_TRUE(contains(scene.clips.at(0).broken, "accessors[2]: needs 3600 bytes"));
}

TEST(LoadSceneReports, CameraAxesThatAreParallelAreRefused) {
    GltfBuilder file = triangle_file();
    file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}});
    file.add_node({{"camera", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 1}}});
    EXPECT_TRUE(contains(load_error(file), "nodes[1]: has a camera but a transform without"));
    file.root["nodes"][1]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 2, 1, 0, 0, 0, 0, 1};
    EXPECT_EQ(load_error(file), "");
}

TEST(LoadSceneReports, APlaceholderBufferNeedsNoTag) {
    GltfBuilder file = meshopt_quad("TRIANGLES");
    file.root["buffers"][1].erase("extensions");
    const TempFolder folder;
    write_file(folder.path() / "scene.glb", file.glb());
    EXPECT_EQ(load_error(folder.path() / "scene.glb"), "");
    file.root["bufferViews"][0].erase("extensions");
    write_file(folder.path() / "scene.glb", file.glb());
    EXPECT_TRUE(contains(load_error(folder.path() / "scene.glb"),
                         "buffers[1]: has neither a uri nor a GLB's BIN chunk, and "
                         "bufferViews[0] reads it"));
    file.root["extensionsRequired"] = {"KHR_texture_basisu"};
    write_file(folder.path() / "scene.glb", file.glb());
    EXPECT_TRUE(contains(load_error(folder.path() / "scene.glb"),
                         "the file needs 'KHR_texture_basisu', which is not supported"));
}

std::string error_of(const json& root) {
    GltfBuilder file;
    file.root.update(root);
    return load_error(file);
}

TEST(LoadSceneReports, MessagesNameAPlace) {
    EXPECT_TRUE(contains(error_of({{"skins", {json::object()}}}), "skins[0].joints is missing"));
    EXPECT_TRUE(contains(error_of({{"asset", {{"version", "1.0"}}}, {"buffers", json::object()}}),
                         "asset.version is '1.0', must be 2.0; gltf-pipeline"));
    EXPECT_TRUE(contains(error_of({{"asset", {{"version", 1}}}}),
                         "asset.version is '1', must be 2.0; gltf-pipeline"));
    EXPECT_TRUE(contains(error_of({{"cameras", {{{"type", "perspective"}}}}}),
                         "cameras[0].perspective is missing"));
    EXPECT_TRUE(contains(error_of({{"cameras", {{{"type", "orthographic"}}}}}),
                         "cameras[0].orthographic is missing"));
    EXPECT_TRUE(contains(
        error_of({{"buffers", {{{"byteLength", 8}, {"uri", "data:,12345678"}}}},
                  {"bufferViews", {{{"buffer", 0}, {"byteLength", 8}, {"byteStride", 6}}}}}),
        "bufferViews[0].byteStride is 6, must be an integer from 0 to 252 that "
        "is a multiple of 4"));
}

TEST(LoadSceneReports, IndicesOfASparseAccessorAloneAreRead) {
    GltfBuilder file = triangle_file();
    const int where = file.add_view(bytes_of(std::vector<std::uint16_t>{1, 2}));
    const int what = file.add_view(bytes_of(std::vector<std::uint16_t>{1, 2}));
    file.primitive()["indices"] = file.add(
        "accessors", {{"componentType", kUnsignedShort},
                      {"type", "SCALAR"},
                      {"count", 3},
                      {"sparse",
                       {{"count", 2},
                        {"indices", {{"bufferView", where}, {"componentType", kUnsignedShort}}},
                        {"values", {{"bufferView", what}}}}}});
    EXPECT_EQ(load(file).meshes.at(0).indices, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(LoadSceneReports, UrisAreComparedAsUris) {
    const TempFolder folder;
    GltfBuilder file = triangle_file();
    write_file(folder.path() / "a.bin", file.bin);
    json buffer = json::parse(file.gltf()).at("buffers").at(0);
    std::string data = buffer["uri"];
    for (const std::string& uri : {std::string("gone/../a.bin"), "DATA:" + data.substr(5),
                                   "Data:;BASE64" + data.substr(data.find(','))}) {
        buffer["uri"] = uri;
        file.root["buffers"] = json::array({buffer});
        write_file(folder.path() / "scene.gltf", file.gltf());
        EXPECT_EQ(load_error(folder.path() / "scene.gltf"), "") << uri;
    }
}

std::string error_with_memory(const fs::path& file, std::uint64_t bytes) {
    LoadOptions options;
    options.max_memory_bytes = bytes;
    return load_error(file, options);
}

TEST(LoadSceneReports, MemoryIsAskedForBeforeItIsTaken) {
    constexpr std::uint64_t kMany = std::uint64_t{1} << 40;
    const TempFolder folder;
    const auto make_sparse = [](const fs::path& file, const std::string& begin) {
        write_file(file, begin);
        fs::resize_file(file, kMany);
    };
    make_sparse(folder.path() / "huge.glb", "glTF");
    EXPECT_TRUE(contains(error_with_memory(folder.path() / "huge.glb", 1 << 20),
                         "huge.glb: needs 1048576 MiB of memory"));
    GltfBuilder file = triangle_file();
    make_sparse(folder.path() / "huge.png", "\x89PNG");
    file.add("images", {{"uri", "huge.png"}});
    file.add("textures", {{"source", 0}});
    file.add("materials", {{"emissiveTexture", {{"index", 0}}}});
    write_file(folder.path() / "scene.gltf", file.gltf());
    EXPECT_TRUE(contains(error_with_memory(folder.path() / "scene.gltf", 1 << 20),
                         "images[0]: needs 1048576 MiB of memory"));
}

// Encoded images give their memory back, and so does the text of the file. On one thread: as many
// images as there are threads are in memory at a time.
TEST(LoadSceneReports, MemoryThatIsFreedIsNotCharged) {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const TempFolder folder;
    GltfBuilder file = triangle_file();
    const Blob png = encode_image("png", 1, 3, {1, 2, 3});
    for (int i = 0; i < 8; ++i) {
        const std::string name = std::to_string(i) + ".png";
        write_file(folder.path() / name, png);
        fs::resize_file(folder.path() / name, 400 << 10);
        const int image = file.add("images", {{"uri", name}});
        const int texture = file.add("textures", {{"source", image}});
        file.add("materials", {{"emissiveTexture", {{"index", texture}}}});
    }
    file.root["extras"] = nlohmann::json::array_t(100, std::string(4 << 10, ' '));
    write_file(folder.path() / "scene.gltf", file.gltf());
    EXPECT_EQ(error_with_memory(folder.path() / "scene.gltf", 2200 << 10), "");
}

TEST(LoadSceneReports, MetadataIsNothingThatAPictureLacks) {
    GltfBuilder file = triangle_file();
    file.root["extensionsUsed"] = {"EXT_structural_metadata",
                                   "EXT_mesh_features",
                                   "EXT_instance_features",
                                   "KHR_xmp_json_ld",
                                   "EXT_mesh_manifold",
                                   "KHR_node_hoverability",
                                   "KHR_node_selectability",
                                   "AGI_stk_metadata",
                                   "GODOT_single_root",
                                   "KHR_audio",
                                   "MPEG_media",
                                   "OMI_collider",
                                   "KHR_physics_rigid_bodies"};
    file.root["extensionsRequired"] = file.root["extensionsUsed"];
    LoadOptions options;
    options.strict = true;
    EXPECT_EQ(load(file, options).meshes.size(), 1u);
}

TEST(LoadSceneReports, BuffersAndViewsThatNothingReadsMayBeBroken) {
    GltfBuilder file = triangle_file();
    file.root["buffers"] = {{{"byteLength", 72}}, {{"byteLength", 8}, {"uri", "gone.bin"}}};
    const TempFolder folder;
    const auto path = folder.path() / "scene.glb";
    write_file(path, file.glb());
    EXPECT_EQ(load_error(path), "");
    file.root["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 8}});
    write_file(path, file.glb());
    EXPECT_EQ(load_error(path), "");
    file.root["accessors"][1]["bufferView"] = file.root["bufferViews"].size() - 1;
    write_file(path, file.glb());
    EXPECT_TRUE(contains(load_error(path), "buffers[1]: file 'gone.bin': no such file"))
        << load_error(path);
}

TEST(LoadSceneReports, AnAnimationThatDoesNotPlayMayBreakRules) {
    GltfBuilder file = triangle_file();
    for (const json& sampler : {json{{"input", 99}, {"output", 0}},
                                json{{"input", 0}, {"output", 0}, {"interpolation", "FOO"}}}) {
        file.root["animations"] = {
            {{"name", "bad"},
             {"samplers", {sampler}},
             {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
        EXPECT_TRUE(contains(load_error(file), "animations[0].samplers[0].in"));
        LoadOptions options;
        options.clips = {"none"};
        const Scene scene = load(file, options);
        ASSERT_EQ(scene.clips.size(), 1u);
        EXPECT_EQ(scene.clips[0].name, "bad");
        EXPECT_TRUE(contains(scene.clips[0].broken, "animations[0].samplers[0].in"));
    }
}

}  // namespace
}  // namespace kilolux
