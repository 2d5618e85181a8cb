// SPDX-License-Identifier: Apache-2.0
// Golden pictures of glTF files: of everything that the loader supports, and of textures in files.
// golden/every_feature.exr is made by render_golden()'s command with --exr-half.
#include <gtest/gtest.h>

#include "tests/support/child.h"
#include "tests/support/gltf_seeds.h"
#include "tests/support/paths.h"

namespace kilolux {
namespace {

// RMSE. Half precision of the files makes 0.8e-4 to 2.1e-4 of it; lane widths of 1 to 16, tunings,
// and vectors of 128 and 256 bits in OpenGL change less than 1e-6. tests/CMakeLists.txt has the
// same.
constexpr const char* kGoldenTolerance = "4e-4";

// Side by side, since coinciding planes have no unique picture, and less bright.
GltfBuilder side_by_side() {
    GltfBuilder file = every_feature_file();
    nlohmann::json& nodes = file.root["nodes"];
    nodes[2]["matrix"][12] = 1.2;
    nodes[3]["translation"] = {0.0, 1.3, 0.0};
    nodes[10]["translation"] = {1.2, 1.3, 0.0};
    nodes[11]["translation"] = {2.4, 1.3, 0.0};
    file.root["materials"][0]["alphaCutoff"] = 0.1;
    file.root["materials"][0]["extensions"]["KHR_materials_emissive_strength"] = {
        {"emissiveStrength", 0.2}};
    nlohmann::json& lights = file.root["extensions"]["KHR_lights_punctual"]["lights"];
    lights[0]["intensity"] = 3;
    lights[2]["intensity"] = 1;
    return file;
}

ChildResult render_golden(const std::string& scene, const std::string& picture) {
    const std::string golden = source_root() + "/tests/golden/every_feature.exr";
    return run_kilolux({"render",
                        scene,
                        "--camera-position",
                        "2.1,1.4,3.6",
                        "--camera-focal-point",
                        "1.5,1.1,0",
                        "--lights",
                        "100",
                        "--light-intensity",
                        "0.3",
                        "--light-radius",
                        "2",
                        "--ambient",
                        "0.1",
                        "--resolution",
                        "96,64",
                        "--time",
                        "0.3",
                        "--quiet",
                        "-o",
                        picture,
                        "--reference",
                        golden,
                        "--metric",
                        "rmse",
                        "--threshold",
                        kGoldenTolerance});
}

TEST(GoldenFiles, EveryFeatureLooksAsItDid) {
    const TempFolder folder;
    const std::string scene = write_with_files(side_by_side(), folder.path()).string();
    const ChildResult result = render_golden(scene, (folder.path() / "a.exr").string());
    EXPECT_EQ(result.code, 0) << result.out << result.err;
}

TEST(GoldenFiles, SoDoesTheSameFileInOne) {
    const TempFolder folder;
    const std::string scene = (folder.path() / "scene.glb").string();
    write_file(scene, side_by_side().glb());
    const ChildResult result = render_golden(scene, (folder.path() / "a.exr").string());
    EXPECT_EQ(result.code, 0) << result.out << result.err;
}

// The atrium's textures through PNG files: the golden picture of the atrium itself.
TEST(GoldenFiles, ExportedTexturesLookLikeTheirScene) {
    const TempFolder folder;
    const std::string scene = (folder.path() / "atrium.gltf").string();
    const ChildResult exported =
        run_kilolux({"export", "atrium", "--lights", "200", "--quiet", "-o", scene});
    ASSERT_EQ(exported.code, 0) << exported.err;
    const std::string golden = source_root() + "/tests/golden/atrium.exr";
    const std::string picture = (folder.path() / "a.exr").string();
    const ChildResult result = run_kilolux(
        {"render",       scene,         "--lights",      "0",           "--fit",        "height",
         "--resolution", "96,64",       "--geometry",    "compute",     "--anisotropy", "1",
         "-q",           "-o",          picture,         "--reference", golden,         "--metric",
         "rmse",         "--threshold", kGoldenTolerance});
    EXPECT_EQ(result.code, 0) << result.out << result.err;
}

}  // namespace
}  // namespace kilolux
