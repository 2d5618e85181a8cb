// SPDX-License-Identifier: Apache-2.0
// Scene files with defects, through the program: those written here, and those that others made,
// which are skipped where their folder is not there.
#include <gtest/gtest.h>

#include "present/image/image_file.h"
#include "tests/support/child.h"
#include "tests/support/gltf_seeds.h"
#include "tests/support/messages.h"
#include "tests/support/paths.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

fs::path scenes() { return fs::path(source_root()) / ".." / "shared" / "scenes"; }

void expect_one_line(const std::string& file, const std::string& message) {
    const TemporaryFolder output;
    const std::string picture = (output / "picture.exr").string();
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"info", file}, {"render", file, "-o", picture}}) {
        const ChildResult result = run_kilolux(words);
        EXPECT_EQ(result.code, 1) << words[0] << " " << result.err;
        EXPECT_EQ(result.out, "") << words[0] << " " << file;
        EXPECT_TRUE(result.err.starts_with("kilolux: " + file + ": " + message)) << result.err;
        EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << result.err;
        EXPECT_FALSE(fs::exists(picture));
    }
}

// The light of a small picture.
double rendered_light(const std::string& file) {
    const TemporaryFolder output;
    const std::string picture = (output / "picture.exr").string();
    const ChildResult result = run_kilolux(
        {"render", file, "--lights", "100", "-q", "--resolution", "64,36", "-o", picture});
    EXPECT_EQ(result.code, 0) << file << ": " << result.err;
    if (result.code != 0) return 0.0;
    double sum = 0.0;
    for (const float value : read_image(picture).values) sum += double{value};
    return sum;
}

TEST(SceneDefects, EndInOneLineAndExitOne) {
    const TemporaryFolder folder;
    const std::string file = (folder / "broken.gltf").string();
    GltfBuilder bytes = triangle_file(), buffer = triangle_file(), version = triangle_file();
    bytes.root["bufferViews"][0]["byteLength"] = 1e300;
    buffer.root["bufferViews"][1]["buffer"] = 1;
    version.root["asset"]["version"] = "";
    const std::pair<const GltfBuilder*, const char*> cases[] = {
        {&bytes, "bufferViews[0].byteLength is 1e+300"},
        {&buffer, "bufferViews[1].buffer is 1"},
        {&version, "asset.version is ''"}};
    for (const auto& [builder, message] : cases) {
        write_file(file, builder->gltf());
        expect_one_line(file, message);
    }
}

TEST(SceneDefects, ThatAreHarmlessRender) {
    const TemporaryFolder folder;
    const std::string skin = (folder / "skin.gltf").string();
    const std::string chunk = (folder / "chunk.glb").string();
    const std::string nodes = (folder / "nodes.gltf").string();
    GltfBuilder unused = triangle_file();
    unused.add("skins", {{"joints", {0}}, {"skeleton", 0}});
    write_file(skin, unused.gltf());
    EXPECT_GT(rendered_light(skin), 0.0) << "a skin that no node uses";
    Blob glb = triangle_file().glb();
    glb.insert(glb.end(), {0, 0, 0, 0, 'X', 'T', 'R', 'A'});
    const auto size = static_cast<std::uint32_t>(glb.size());
    std::memcpy(&glb[8], &size, sizeof(size));
    write_file(chunk, glb);
    EXPECT_GT(rendered_light(chunk), 0.0) << "an empty chunk of an unknown type";
    GltfBuilder alone;
    alone.add_node({{"name", "alone"}});
    write_file(nodes, alone.gltf());
    EXPECT_EQ(rendered_light(nodes), 0.0) << "nodes alone";
}

TEST(SharedScenes, BrokenOnesEndInOneLineAndExitOne) {
    const fs::path folder = scenes() / "malformed";
    if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there";
    const std::pair<const char*, const char*> cases[] = {
        {"integer-out-of-bounds.gltf", "bufferViews[0].byteLength is 1e+300"},
        {"invalid-buffer-index.gltf", "bufferViews[1].buffer is 1"},
        {"issue-416.gltf", "asset.version is ''"}};
    for (const auto& [name, message] : cases) expect_one_line((folder / name).string(), message);
}

TEST(SharedScenes, HarmlessDefectsAndSmallOnesRender) {
    if (!fs::exists(scenes() / "small")) GTEST_SKIP() << scenes() << " is not there";
    for (const char* name :
         {"malformed/unassigned-skeleton.gltf", "malformed/zero-sized-bin-chunk-issue-440.glb",
          "malformed/issue-492.glb", "small/BoxMeshopt.glb",
          "small/CubeImageUriSpaces/CubeImageUriMultipleSpaces.gltf"}) {
        const bool empty = std::string(name) == "malformed/issue-492.glb";
        EXPECT_EQ(rendered_light((scenes() / name).string()) > 0.0, !empty) << name;
    }
}

}  // namespace
}  // namespace kilolux
