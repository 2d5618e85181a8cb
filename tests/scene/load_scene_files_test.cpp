// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "host/scene/load_scene.h"
#include "tests/scene/gltf_builder.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

fs::path scenes() { return fs::path(KILOLUX_ROOT) / ".." / "shared" / "scenes"; }

std::vector<fs::path> gltf_files(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
        const std::string extension = entry.path().extension().string();
        if (extension == ".gltf" || extension == ".glb") files.push_back(entry.path());
    }
    return files;
}

TEST(LoadSceneFiles, ReadsSponza) {
    const fs::path file = scenes() / "sponza" / "Sponza.gltf";
    if (!fs::exists(file)) GTEST_SKIP() << file << " is not there";
    const Scene scene = load_scene(file);
    EXPECT_EQ(scene_defect(scene), "");
    EXPECT_EQ(triangle_count(scene), 262267u);
    EXPECT_EQ(scene.meshes.size(), 103u);
    EXPECT_EQ(scene.materials.size(), 25u);
    EXPECT_EQ(scene.images.size(), 69u);
    const Box box = bounds(scene);
    EXPECT_NEAR(glm::length(box.min - glm::dvec3(-15.37, -1.01, -9.46)), 0.0, 0.02);
    EXPECT_NEAR(glm::length(box.max - glm::dvec3(14.40, 11.44, 8.84)), 0.0, 0.02);
}

TEST(LoadSceneFiles, ReadsTheHelmet) {
    const fs::path file = scenes() / "helmet" / "DamagedHelmet.glb";
    if (!fs::exists(file)) GTEST_SKIP() << file << " is not there";
    const Scene scene = load_scene(file);
    EXPECT_EQ(scene_defect(scene), "");
    EXPECT_EQ(triangle_count(scene), 15452u);
    EXPECT_EQ(scene.images.size(), 5u);
    EXPECT_TRUE(scene.materials.at(0).occlusion_texture.present());
    EXPECT_FALSE(scene.meshes.at(0).tangents.empty());
}

TEST(LoadSceneFiles, ReadsAllSmallScenes) {
    if (!fs::exists(scenes() / "small")) GTEST_SKIP() << "no small scenes";
    for (const fs::path& file : gltf_files(scenes() / "small")) {
        const Scene scene = load_scene(file);
        EXPECT_EQ(scene_defect(scene), "") << file;
        EXPECT_GT(triangle_count(scene), 0u) << file;
    }
}

TEST(LoadSceneFiles, LoadsOrNamesAllMalformedScenes) {
    if (!fs::exists(scenes() / "malformed")) GTEST_SKIP() << "no malformed scenes";
    const std::vector<std::pair<const char*, const char*>> expected = {
        {"integer-out-of-bounds.gltf", "bufferViews[0].byteLength is 1e+300"},
        {"invalid-buffer-index.gltf", "bufferViews[1].buffer is 1"},
        {"invalid-buffer-view-index.gltf", "bufferViews[0].buffer is 0"},
        {"invalid-primitive-indices.gltf", "bufferViews[0].buffer is 0"},
        {"issue-416.gltf", "asset.version is ''"},
        {"issue-492.glb", ""},
        {"unassigned-skeleton.gltf", ""},
        {"zero-sized-bin-chunk-issue-440.glb", ""}};
    for (const auto& [name, part] : expected) {
        const std::string error = load_error(scenes() / "malformed" / name);
        EXPECT_EQ(error.empty(), std::string(part).empty()) << name << ": " << error;
        EXPECT_NE(error.find(part), std::string::npos) << name << ": " << error;
        EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    }
}

}  // namespace
}  // namespace kilolux
