// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "host/scene/gltf/load_scene.h"
#include "tests/support/gltf_builder.h"

namespace kilolux {
namespace {

using nlohmann::json;

// Sets a value of a triangle's file by JSON pointer; the error must be one line that holds `part`.
void expect_error(const char* pointer, const json& value, const std::string& part) {
    GltfBuilder file = triangle_file();
    file.root["buffers"] = nlohmann::json::parse(file.gltf()).at("buffers");
    file.root[json::json_pointer(pointer)] = value;
    const std::string error = load_error(file);
    EXPECT_NE(error.find(part), std::string::npos) << pointer << " = " << value << ": " << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    EXPECT_EQ(error.find("scene.gltf: ") == std::string::npos, error.empty()) << error;
}

TEST(LoadSceneBroken, NamesTypesThatAreWrong) {
    expect_error("/accessors/0/count", "three",
                 "accessors[0].count is \"three\", must be an integer");
    expect_error("/accessors/0/count", -3, "accessors[0].count is -3");
    expect_error("/accessors/0/count", 2.5, "accessors[0].count is 2.5");
    expect_error("/accessors/0/count", nullptr, "accessors[0].count is null");
    expect_error("/accessors/1/type", "VEC5",
                 "accessors[1].type is \"VEC5\", must be one of SCALAR");
    expect_error("/accessors/0/componentType", 5124, "accessors[0].componentType is 5124");
    expect_error("/nodes/0/translation", {1, 2},
                 "nodes[0].translation is [1,2], must be an array of 3");
    expect_error("/nodes/0/matrix", "identity", "nodes[0].matrix is \"identity\"");
    expect_error("/nodes/0/rotation", {0, 0, "x", 1}, "nodes[0].rotation");
    expect_error("/cameras", json::object(), "cameras is an object, must be an array");
    expect_error("/nodes/0", 7, "nodes[0] is 7, must be an object");
    expect_error("/meshes/0/primitives", 7, "meshes[0].primitives is 7, must be an array");
    expect_error("/meshes/0/primitives/0/attributes", {1}, "attributes is [1], must be an object");
    expect_error("/meshes/0/primitives/0/mode", 9, "mode is 9, must be an integer from 0 to 6");
    expect_error("/bufferViews/0/byteStride", 6, "byteStride");
    expect_error("/bufferViews/0/byteLength", 1e300, "bufferViews[0].byteLength is 1e+300");
    expect_error("/extensionsUsed", "KHR_x", "extensionsUsed is \"KHR_x\", must be an array");
    expect_error("/materials", {{{"alphaMode", "GLASS"}}}, "materials[0].alphaMode is \"GLASS\"");
    expect_error("/cameras", {{{"type", "fisheye"}}}, "cameras[0].type is \"fisheye\"");
    expect_error("/asset", json::object(), "asset.version is missing");
    expect_error("/asset/version", "", "asset.version is '', must be 2.0");
    expect_error("/asset/version", "1.0", "asset.version is '1.0', must be 2.0");
    expect_error("/asset/minVersion", "2.7", "asset.minVersion is '2.7'");
}

TEST(LoadSceneBroken, NamesIndicesOutOfRange) {
    expect_error("/nodes/0/mesh", 1, "nodes[0].mesh is 1, must be an index into the 1 meshes");
    expect_error("/nodes/0/mesh", -1, "nodes[0].mesh is -1");
    expect_error("/nodes/0/children", {5},
                 "nodes[0].children[0] is 5, must be an index into the 1");
    expect_error("/scene", 2, "scene is 2, must be an index into the 1 scenes");
    expect_error("/scenes/0/nodes", {1}, "scenes[0].nodes[0] is 1");
    expect_error("/meshes/0/primitives/0/material", 0, "must be an index into the 0 materials");
    expect_error("/meshes/0/primitives/0/indices", 2, "indices is 2, must be an index into the 2");
    expect_error("/meshes/0/primitives/0/attributes/POSITION", 9, "POSITION\" is 9");
    expect_error("/accessors/0/bufferView", 2, "accessors[0].bufferView is 2");
    expect_error("/bufferViews/0/buffer", 1,
                 "bufferViews[0].buffer is 1, must be an index into the 1");
    expect_error("/nodes/0/skin", 0, "nodes[0].skin is 0, must be an index into the 0 skins");
    expect_error("/nodes/0/extensions", {{"KHR_lights_punctual", {{"light", 0}}}},
                 "light is 0, must be an index into the 0 lights");
}

TEST(LoadSceneBroken, NamesBytesOutOfRange) {
    expect_error("/accessors/0/count", 4,
                 "accessors[0]: needs 48 bytes from byte 0 of bufferViews[0]");
    expect_error("/accessors/0/byteOffset", 4, "accessors[0]: needs 36 bytes from byte 4");
    expect_error("/accessors/0/byteOffset", 9007199254740992, "accessors[0]: needs");
    expect_error("/bufferViews/0/byteStride", 16, "accessors[0]: needs 44 bytes");
    expect_error("/bufferViews/0/byteLength", 73,
                 "bufferViews[0]: byteOffset 0 and byteLength 73 leave");
    expect_error("/bufferViews/0/byteOffset", 9007199254740992,
                 "bufferViews[0]: byteOffset 900719925");
    expect_error("/buffers/0/byteLength", 73,
                 "buffers[0]: byteLength is 73, the data hold 72 bytes");
    expect_error("/buffers/0/uri", "gone.bin", "buffers[0]: file 'gone.bin': no such file");
    expect_error("/buffers/0", {{"byteLength", 72}}, "buffers[0]: has neither a uri nor");
}

TEST(LoadSceneBroken, NamesVertexIndicesOutOfRange) {
    GltfBuilder file = triangle_file();
    file.primitive()["indices"] = file.add_indices({0, 1, 3});
    const std::string error = load_error(file);
    EXPECT_NE(error.find("accessors[2]: index 2 is 3, must be below the 3 vertices"),
              std::string::npos)
        << error;
}

TEST(LoadSceneBroken, NamesAttributesOfOddShapes) {
    GltfBuilder file = triangle_file();
    const int two = file.add_floats("VEC3", {0, 0, 1, 0, 0, 1});
    const int scalars = file.add_floats("SCALAR", {0, 1, 2});
    file.primitive()["attributes"]["NORMAL"] = two;
    EXPECT_NE(load_error(file).find("NORMAL has 2 elements, POSITION has 3"), std::string::npos);
    file.primitive()["attributes"]["NORMAL"] = scalars;
    EXPECT_NE(load_error(file).find("which NORMAL cannot have"), std::string::npos);
    file.primitive()["attributes"].erase("NORMAL");
    file.primitive()["indices"] = two;
    EXPECT_NE(load_error(file).find("which indices cannot have"), std::string::npos);
    file.primitive()["indices"] = scalars;
    EXPECT_NE(load_error(file).find("must be unsigned for indices"), std::string::npos);
}

TEST(LoadSceneBroken, NamesPositionsThatAreNotFinite) {
    for (const float odd :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        GltfBuilder file = triangle_file();
        file.primitive()["attributes"]["POSITION"] =
            file.add_floats("VEC3", {0, 0, 0, 1, 0, 0, 0, odd, 0});
        const std::string error = load_error(file);
        EXPECT_NE(error.find("accessors[2]: element 2 holds"), std::string::npos) << error;
    }
}

TEST(LoadSceneBroken, LoadsDenormalPositionsAndRefusesInfiniteTransforms) {
    GltfBuilder file = triangle_file();
    file.primitive()["attributes"]["POSITION"] =
        file.add_floats("VEC3", {1e-42f, 0, 0, 1, 0, 0, 0, 1e-45f, 0});
    EXPECT_EQ(load_error(file), "");
    file.root["nodes"] = {{{"scale", {1e200, 1, 1}}, {"children", {1}}},
                          {{"scale", {1e200, 1, 1}}, {"mesh", 0}}};
    EXPECT_NE(load_error(file).find("nodes[1]: has a world transform that is not finite"),
              std::string::npos);
}

TEST(LoadSceneBroken, NamesCyclesAndSecondParents) {
    GltfBuilder file = triangle_file();
    file.root["nodes"] = {{{"children", {1}}}, {{"children", {2}}}, {{"children", {1}}}};
    EXPECT_NE(load_error(file).find("nodes[1]: is a child of both nodes[0] and nodes[2]"),
              std::string::npos);
    file.root["nodes"] = {{{"mesh", 0}}, {{"children", {2}}}, {{"children", {1}}}};
    EXPECT_NE(load_error(file).find("nodes[1]: hangs on a cycle"), std::string::npos);
    file.root["nodes"] = {{{"children", {0}}}};
    EXPECT_NE(load_error(file).find("nodes[0]: hangs on a cycle"), std::string::npos);
}

TEST(LoadSceneBroken, RefusesGigabytesClaimedByAFewBytes) {
    GltfBuilder file = triangle_file();
    file.root["accessors"][0] = {
        {"componentType", kFloat}, {"type", "VEC3"}, {"count", 4000000000}};
    file.root["accessors"][1] = file.root["accessors"][0];
    EXPECT_NE(load_error(file).find("claims 4000000000 elements"), std::string::npos)
        << load_error(file);
    file.primitive()["indices"] = file.add_indices({0, 1, 2});
    EXPECT_NE(load_error(file).find("claims 4000000000 elements"), std::string::npos);
    file = triangle_file();
    const json many(2000, file.primitive());
    file.root["meshes"][0]["primitives"] = many;
    for (int n = 0; n < 20000; ++n) file.add_node({{"mesh", 0}});
    EXPECT_NE(load_error(file).find("nodes: claims"), std::string::npos) << load_error(file);
}

TEST(LoadSceneBroken, NamesSparsePartsOutOfOrder) {
    for (const Blob& elements : {Blob{2, 1}, Blob{1, 1}, Blob{1, 3}}) {
        GltfBuilder file = triangle_file();
        const int indices = file.add_view(elements);
        const int values = file.add_view(Blob(24));
        file.root["accessors"][0]["sparse"] = {
            {"count", 2},
            {"indices", {{"bufferView", indices}, {"componentType", kUnsignedByte}}},
            {"values", {{"bufferView", values}}}};
        const std::string error = load_error(file);
        EXPECT_NE(error.find("accessors[0].sparse.indices: value 1 is"), std::string::npos)
            << error;
    }
}

TEST(LoadSceneBroken, NamesFilesThatAreNoGltf) {
    const TempFolder folder;
    const auto error_of = [&](const std::string& text) {
        write_file(folder.path() / "x.gltf", text);
        return load_error(folder.path() / "x.gltf");
    };
    for (const char* text : {"", "{", "hello", "[1]", "5", "{\"asset\":}", "\x89PNG\r\n", "glTF",
                             "{\"asset\":{\"version\":\"2.0\"},\"x\":1e999}", "\"\xff\""}) {
        const std::string error = error_of(text);
        EXPECT_NE(error.find("x.gltf"), std::string::npos) << text << ": " << error;
        EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    }
    EXPECT_NE(error_of(std::string(1000000, '[')).find("nested deeper"), std::string::npos);
    EXPECT_NE(load_error(folder.path() / "none.gltf").find("no such file"), std::string::npos);
    EXPECT_NE(load_error(folder.path()).find("not a regular file"), std::string::npos);
}

std::string long_data_uri(std::size_t bytes) {
    return "data:application/octet-stream;base64," + std::string(bytes / 3 * 4, 'A');
}

// Data URIs are decoded where they stand, and the parser sees shorter ones.
TEST(LoadSceneBroken, NamesTheColumnOfTheFileBehindDataUris) {
    const TempFolder folder;
    const std::string uri = '"' + long_data_uri(6000) + '"';
    const std::string two = "\"a\":" + uri + ",\"b\":" + uri + ",";
    for (const std::string& before :
         {"{" + two, "{" + two + "\n" + two, "{" + two + "\n", "{\n" + two}) {
        write_file(folder.path() / "x.gltf", before + ":");
        const std::string error = load_error(folder.path() / "x.gltf");
        const std::size_t line = before.find('\n') == std::string::npos ? 1 : 2;
        const std::size_t column = before.size() - (before.rfind('\n') + 1) + 1;
        EXPECT_NE(error.find(fmt::format("at line {}, column {}:", line, column)),
                  std::string::npos)
            << error;
    }
}

// The short texts that stand for long data URIs are no URIs of the file.
TEST(LoadSceneBroken, TakesNoUriForAnotherOfTheFile) {
    GltfBuilder file = triangle_file();
    file.add("images", {{"uri", long_data_uri(6000)}});
    const std::string name = long_data_uri(6000).substr(0, 80) + "#0";
    file.root["buffers"] = {{{"byteLength", 6000}, {"uri", long_data_uri(6000)}},
                            {{"byteLength", 60}, {"uri", name}}};
    file.root["bufferViews"][0]["buffer"] = 1;
    const TempFolder folder;
    write_file(folder.path() / "x.gltf", file.root.dump());
    const std::string error = load_error(folder.path() / "x.gltf");
    EXPECT_NE(error.find("buffers[1]: data URI holds broken base64"), std::string::npos) << error;
}

TEST(LoadSceneBroken, LoadsFilesWithHarmlessDefects) {
    GltfBuilder skeleton;  // a skin and its nodes without a mesh
    skeleton.add_node({{"children", {1}}});
    skeleton.add("nodes", {{"name", "joint"}});
    skeleton.add("skins", {{"joints", {0, 1}}});
    EXPECT_EQ(load_error(skeleton), "");
    GltfBuilder unused = triangle_file();  // a skin that no node uses
    unused.add("skins", {{"joints", {0}}, {"skeleton", 0}});
    EXPECT_EQ(triangle_count(load(unused)), 1u);
    // An empty BIN chunk behind the JSON, which needs none.
    Blob glb = GltfBuilder{}.glb();
    glb.insert(glb.end(), {0, 0, 0, 0, 'B', 'I', 'N', 0});
    glb[8] = static_cast<unsigned char>(glb.size());
    const TempFolder folder;
    write_file(folder.path() / "x.glb", glb);
    EXPECT_EQ(load_error(folder.path() / "x.glb"), "");
}

TEST(LoadSceneBroken, RefusesATruncatedGlbAtEveryLength) {
    const TempFolder folder;
    const Blob glb = triangle_file().glb();
    for (std::size_t size = 0; size < glb.size(); ++size) {
        write_file(folder.path() / "x.glb",
                   Blob(glb.begin(), glb.begin() + static_cast<std::ptrdiff_t>(size)));
        EXPECT_NE(load_error(folder.path() / "x.glb"), "") << size;
    }
}

TEST(LoadSceneBroken, NamesGlbHeadersThatLie) {
    const TempFolder folder;
    const auto error_with = [&](std::size_t byte, unsigned char value) {
        Blob glb = triangle_file().glb();
        glb[byte] = value;
        write_file(folder.path() / "x.glb", glb);
        return load_error(folder.path() / "x.glb");
    };
    EXPECT_NE(error_with(4, 1).find("GLB version is 1, must be 2"), std::string::npos);
    EXPECT_NE(error_with(11, 0xff).find("GLB header claims"), std::string::npos);
    EXPECT_NE(error_with(15, 0xff).find("GLB chunk at byte 12 claims"), std::string::npos);
    EXPECT_NE(error_with(16, 'X').find("first chunk of the GLB is not JSON"), std::string::npos);
}

void append(Blob& glb, const std::string& bytes) {
    glb.insert(glb.end(), bytes.begin(), bytes.end());
    glb[8] = static_cast<unsigned char>(glb.size() & 255u);
    glb[9] = static_cast<unsigned char>(glb.size() >> 8);
}

// Chunk lengths of a GLB are multiples of 4; some writers' JSON is not.
TEST(LoadSceneBroken, ReadsAGlbWhoseJsonIsNotPadded) {
    const TempFolder folder;
    const auto file = folder.path() / "x.glb";
    Blob glb = triangle_file().glb(false);
    write_file(file, glb);
    ASSERT_EQ(glb[12] % 4, 1);
    testing::internal::CaptureStderr();
    EXPECT_EQ(world_positions(load_scene(file)).at(1), glm::dvec3(1, 0, 0));
    const std::string warning = testing::internal::GetCapturedStderr();
    EXPECT_NE(warning.find("x.glb: the GLB's JSON chunk at byte 12 has "), std::string::npos)
        << warning;
    EXPECT_NE(warning.find("; read by its length"), std::string::npos) << warning;
    // Padded, but the length does not count the padding.
    glb = triangle_file().glb();
    std::size_t spaces = 0;
    while (glb[19u + glb[12] + 256u * glb[13] - spaces] == ' ') ++spaces;
    ASSERT_GT(spaces, 0u) << "the test's JSON needs padding";
    glb[12] = static_cast<unsigned char>(glb[12] - spaces);
    write_file(file, glb);
    EXPECT_EQ(load_error(file), "");
    // Without a chunk behind it.
    write_file(file, GltfBuilder{}.glb(false));
    EXPECT_EQ(load_error(file), "");
}

TEST(LoadSceneBroken, NamesAChunkThatIsNotPaddedWhereNoneFollows) {
    const TempFolder folder;
    const auto file = folder.path() / "x.glb";
    Blob glb = GltfBuilder{}.glb(false);
    append(glb, std::string(12, '\xff'));
    write_file(file, glb);
    const std::string error = load_error(file);
    EXPECT_NE(error.find(
                  "x.glb: the GLB's JSON chunk at byte 12 has 29 bytes, which is no multiple of 4, "
                  "and no chunk follows it: a chunk is padded to 4 bytes"),
              std::string::npos)
        << error;
}

TEST(LoadSceneBroken, NamesAToolWhereItHelps) {
    const auto error_of = [](const char* pointer, const json& value) {
        GltfBuilder file = triangle_file();
        file.root[json::json_pointer(pointer)] = value;
        return load_error(file);
    };
    EXPECT_NE(error_of("/asset/version", "1.0").find("gltf-pipeline -i old.gltf -o new.gltf"),
              std::string::npos);
    EXPECT_TRUE(error_of("/asset/version", "3.0").ends_with("asset.version is '3.0', must be 2.0"));
}

}  // namespace
}  // namespace kilolux
