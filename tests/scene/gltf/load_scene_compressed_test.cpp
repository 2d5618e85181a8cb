// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>

#include "host/scene/gltf/load_scene.h"
#include "tests/scene/expect_near.h"
#include "tests/support/gltf_compressed.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

using nlohmann::json;

Scene load_glb(const GltfBuilder& file) {
    const TempFolder folder;
    write_file(folder.path() / "scene.glb", file.glb());
    return load_scene(folder.path() / "scene.glb");
}

std::string glb_error(const GltfBuilder& file) {
    const TempFolder folder;
    write_file(folder.path() / "scene.glb", file.glb());
    return load_error(folder.path() / "scene.glb");
}

TEST(LoadSceneMeshopt, DecodesAttributesAndBothKindsOfIndices) {
    for (const char* mode : {"TRIANGLES", "INDICES"}) {
        const Scene scene = load_glb(meshopt_quad(mode));
        EXPECT_EQ(scene_defect(scene), "") << mode;
        ASSERT_EQ(triangle_count(scene), 2u) << mode;
        expect_near(world_positions(scene)[2], {1, 1, 0}, 0.0);
        expect_near(world_positions(scene)[5], {0, 1, 0}, 0.0);
    }
}

// Normals of a triangle through a filter, as the decoder leaves them.
std::vector<glm::vec3> filtered_normals(const Blob& filtered, const Meshopt& meshopt,
                                        const json& accessor_part) {
    GltfBuilder file = triangle_file();
    json accessor = accessor_part;
    accessor["bufferView"] = add_meshopt_view(
        file, encode_vertices(filtered.data(), meshopt.count, meshopt.stride), meshopt);
    accessor["type"] = "VEC3";
    accessor["count"] = 3;
    file.primitive()["attributes"]["NORMAL"] = file.add("accessors", accessor);
    add_fallback_buffer(file);
    return load_glb(file).meshes.at(0).normals;
}

TEST(LoadSceneMeshopt, UndoesTheOctahedralFilter) {
    const std::vector<float> normals = {0, 0, 1, 0, 0.6f, 0, 0.8f, 0, 0, -1, 0, 0};
    Blob bytes(12);
    meshopt_encodeFilterOct(bytes.data(), 3, 4, 8, normals.data());
    const auto read = filtered_normals(bytes, {"ATTRIBUTES", "OCTAHEDRAL", 3, 4},
                                       {{"componentType", kByte}, {"normalized", true}});
    for (std::size_t v = 0; v < 3; ++v) {
        const glm::dvec3 expected(normals[4 * v], normals[4 * v + 1], normals[4 * v + 2]);
        expect_near(glm::dvec3(read[v]), expected, 0.02);  // 8 bits
    }
}

TEST(LoadSceneMeshopt, UndoesTheExponentialFilter) {
    const std::vector<float> normals = {0, 0, 1, 0.6f, 0, 0.8f, 0, -1, 0};
    Blob bytes(36);
    meshopt_encodeFilterExp(bytes.data(), 3, 12, 15, normals.data());
    const auto read =
        filtered_normals(bytes, {"ATTRIBUTES", "EXPONENTIAL", 3, 12}, {{"componentType", kFloat}});
    expect_near(glm::dvec3(read[1]), {0.6, 0, 0.8}, 1e-3);
}

TEST(LoadSceneMeshopt, UndoesTheQuaternionFilter) {
    GltfBuilder file = triangle_file();
    const float s = std::sqrt(0.5f);
    const std::vector<float> rotations = {0, 0, s, s};
    Blob bytes(8);
    meshopt_encodeFilterQuat(bytes.data(), 1, 8, 16, rotations.data());
    const int view = add_meshopt_view(file, encode_vertices(bytes.data(), 1, 8),
                                      {"ATTRIBUTES", "QUATERNION", 1, 8});
    const int output = file.add("accessors", {{"bufferView", view},
                                              {"componentType", kShort},
                                              {"normalized", true},
                                              {"type", "VEC4"},
                                              {"count", 1}});
    const int input = file.add_floats("SCALAR", {0});
    file.add("animations",
             {{"samplers", {{{"input", input}, {"output", output}}}},
              {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}}}}});
    add_fallback_buffer(file);
    expect_near(world_positions(load_glb(file))[1], {0, 1, 0}, 1e-3);
}

TEST(LoadSceneMeshopt, RefusesWhatTheDecoderMustNotSee) {
    const auto error_with = [](const char* key, const json& value) {
        GltfBuilder file = meshopt_quad("TRIANGLES");
        file.root["bufferViews"][1]["extensions"]["EXT_meshopt_compression"][key] = value;
        return glb_error(file);
    };
    for (const auto& [key, value, expected] :
         {std::tuple{"byteStride", json(3), "byteStride is 3, must be 2 or 4"},
          std::tuple{"count", json(7), "count is 7, must be a multiple of 3"},
          std::tuple{"count", json(1500000000), "claims 1500000000 elements"},
          std::tuple{"count", json(9), "data are broken"},
          std::tuple{"byteLength", json(3), "data are broken"},
          std::tuple{"byteOffset", json(1000000), "leave a buffer"},
          std::tuple{"filter", json("OCTAHEDRAL"), "goes only with mode ATTRIBUTES"},
          std::tuple{"mode", json("ATTRIBUTES"), "byteStride is 2, must be a multiple of 4"},
          std::tuple{"mode", json("LINES"), "must be one of ATTRIBUTES"}}) {
        const std::string error = error_with(key, value);
        EXPECT_NE(error.find(expected), std::string::npos)
            << key << " = " << value << ": " << error;
    }
}

TEST(LoadSceneDraco, DecodesBothConnectivityMethods) {
    for (const int method : {kDracoSequential, kDracoEdgebreaker}) {
        const Scene scene = load(draco_file(draco_quad(method)));
        EXPECT_EQ(scene_defect(scene), "");
        ASSERT_EQ(triangle_count(scene), 2u);
        Box box;
        for (const glm::dvec3& p : world_positions(scene)) box.add(p);
        expect_near(box.min, {0, 0, 0}, 1e-3);
        expect_near(box.max, {1, 1, 0}, 1e-3);
        EXPECT_EQ(scene.meshes[0].colors.at(0), glm::vec4(1, 0, 0, 1));
        EXPECT_EQ(scene.meshes[0].normals.at(0), glm::vec3(0, 0, 1));
    }
}

TEST(LoadSceneDraco, RefusesBrokenStreams) {
    const Blob encoded = draco_quad(kDracoEdgebreaker);
    for (std::size_t size = 1; size + 1 < encoded.size(); ++size) {
        const Blob cut(encoded.begin(), encoded.begin() + static_cast<std::ptrdiff_t>(size));
        const std::string error = load_error(draco_file(cut));
        EXPECT_NE(error.find("KHR_draco_mesh_compression: "), std::string::npos) << size << error;
    }
    GltfBuilder file = draco_file(encoded);
    file.primitive()["extensions"]["KHR_draco_mesh_compression"]["attributes"]["COLOR_0"] = 9;
    EXPECT_NE(load_error(file).find("COLOR_0 is attribute 9"), std::string::npos);
}

TEST(LoadSceneDraco, RefusesClaimsOfBillionsOfFaces) {
    // The sequential method's face count is the first number after the 11-byte header.
    Blob encoded = draco_quad(kDracoSequential);
    const Blob huge = {0xff, 0xff, 0xff, 0xff, 0x0f};
    encoded.erase(encoded.begin() + 11);
    encoded.insert(encoded.begin() + 11, huge.begin(), huge.end());
    const std::string error = load_error(draco_file(encoded));
    EXPECT_NE(error.find("claims 4294967295 elements"), std::string::npos) << error;
}

TEST(LoadSceneExtensions, RefusesRequiredAndPassesOptionalUnknownOnes) {
    GltfBuilder file = triangle_file();
    file.root["extensionsUsed"] = {"KHR_materials_sheen", "KHR_mesh_quantization"};
    EXPECT_EQ(load_error(file), "");
    file.root["extensionsRequired"] = {"KHR_texture_basisu"};
    const std::string error = load_error(file);
    EXPECT_NE(error.find("'KHR_texture_basisu'"), std::string::npos) << error;
    EXPECT_NE(error.find("gltf-transform"), std::string::npos) << error;
}

TEST(LoadSceneExtensions, DequantizesMeshes) {
    GltfBuilder file = triangle_file();
    // gltfpack's layout: short positions padded to 8 bytes, undone by the node's scale.
    const Blob positions = bytes_of<std::int16_t>({0, 0, 0, 0, 16000, 0, 0, 0, 0, -16000, 0, 0});
    file.primitive()["attributes"]["POSITION"] =
        file.add_accessor(positions, {kShort, "VEC3", 3, false, 8});
    const Blob normals = bytes_of<std::int8_t>({0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0});
    file.primitive()["attributes"]["NORMAL"] =
        file.add_accessor(normals, {kByte, "VEC3", 3, true, 4});
    file.root["nodes"][0]["scale"] = {0.001, 0.001, 0.001};
    file.root["extensionsRequired"] = {"KHR_mesh_quantization"};
    const Scene scene = load(file);
    EXPECT_EQ(scene_defect(scene), "");
    expect_near(world_positions(scene)[2], {0, -16, 0}, 1e-9);
    EXPECT_EQ(scene.meshes[0].normals[0], glm::vec3(0, 0, 1));
}

// One triangle from `origin` on.
GltfBuilder wide_file(double origin) {
    GltfBuilder file = triangle_file();
    file.primitive()["attributes"]["POSITION"] = file.add_accessor(
        bytes_of<double>({origin, 0, 0, origin + 1, 0, 0, origin, 1, 0}), {kDouble, "VEC3", 3});
    file.root["extensionsRequired"] = {"KHR_accessor_float64"};
    return file;
}

TEST(LoadSceneExtensions, Float64BecomesFloat32WithAWarningOfWhatIsLost) {
    const auto warning_at = [](double origin) {
        testing::internal::CaptureStderr();
        const Scene scene = load(wide_file(origin));
        EXPECT_EQ(world_positions(scene)[1].x, static_cast<float>(origin + 1));
        return testing::internal::GetCapturedStderr();
    };
    EXPECT_EQ(warning_at(0.1), "");
    const std::string warning = warning_at(1000.1);
    EXPECT_TRUE(contains(warning, "positions of 64 bits lose 2e-05 m as floats")) << warning;
    EXPECT_TRUE(contains(load_error(wide_file(1e300)), "element 0 holds 1e+300, must be finite"));
}

TEST(LoadSceneExtensions, AnimationsKeepTheirFloat64) {
    constexpr double kFar = 1e9 + 0.25;
    GltfBuilder file = triangle_file();
    const int input = file.add_floats("SCALAR", {0});
    const int output = file.add_accessor(bytes_of<double>({kFar, 0.1, 0}), {kDouble, "VEC3", 1});
    file.add(
        "animations",
        {{"samplers", {{{"input", input}, {"output", output}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}});
    EXPECT_EQ(world_positions(load(file))[0], glm::dvec3(kFar, 0.1, 0));
}

}  // namespace
}  // namespace kilolux
