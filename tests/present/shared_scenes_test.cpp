// SPDX-License-Identifier: Apache-2.0
// Scenes that others made, through the program; skipped where their folder is not there.
#include <gtest/gtest.h>

#include "present/image/image_file.h"
#include "tests/support/child.h"
#include "tests/support/messages.h"
#include "tests/support/paths.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

fs::path scenes() { return fs::path(source_root()) / ".." / "shared" / "scenes"; }

TEST(SharedScenes, BrokenOnesEndInOneLineAndExitOne) {
    const fs::path folder = scenes() / "malformed";
    if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there";
    const std::pair<const char*, const char*> cases[] = {
        {"integer-out-of-bounds.gltf", "bufferViews[0].byteLength is 1e+300"},
        {"invalid-buffer-index.gltf", "bufferViews[1].buffer is 1"},
        {"issue-416.gltf", "asset.version is ''"}};
    const TemporaryFolder output;
    for (const auto& [name, message] : cases) {
        const std::string file = (folder / name).string();
        const std::string picture = (output / "picture.exr").string();
        for (const std::vector<std::string>& words :
             {std::vector<std::string>{"info", file}, {"render", file, "-o", picture}}) {
            const ChildResult result = run_kilolux(words);
            EXPECT_EQ(result.code, 1) << words[0] << " " << result.err;
            EXPECT_EQ(result.out, "") << words[0] << " " << name;
            EXPECT_TRUE(result.err.starts_with("kilolux: " + file + ": " + message)) << result.err;
            EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << result.err;
            EXPECT_FALSE(fs::exists(picture));
        }
    }
}

TEST(SharedScenes, HarmlessDefectsAndSmallOnesRender) {
    if (!fs::exists(scenes() / "small")) GTEST_SKIP() << scenes() << " is not there";
    const TemporaryFolder output;
    for (const char* name :
         {"malformed/unassigned-skeleton.gltf", "malformed/zero-sized-bin-chunk-issue-440.glb",
          "malformed/issue-492.glb", "small/BoxMeshopt.glb",
          "small/CubeImageUriSpaces/CubeImageUriMultipleSpaces.gltf"}) {
        const std::string picture = (output / "picture.exr").string();
        const ChildResult result =
            run_kilolux({"render", (scenes() / name).string(), "--lights", "100", "-q",
                         "--resolution", "64,36", "-o", picture});
        ASSERT_EQ(result.code, 0) << name << ": " << result.err;
        double sum = 0.0;
        for (const float value : read_image(picture).values) sum += static_cast<double>(value);
        const bool empty = std::string(name) == "malformed/issue-492.glb";
        EXPECT_EQ(sum > 0.0, !empty) << name;
    }
}

}  // namespace
}  // namespace kilolux
