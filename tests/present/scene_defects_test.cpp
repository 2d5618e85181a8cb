// SPDX-License-Identifier: Apache-2.0
// Scene files with defects, through the program: those written here, and those that others made,
// which are skipped where their folder is not there.
#include <gtest/gtest.h>
#include <algorithm>
#include <array>
#include <cmath>

#include "present/image/image_file.h"
#include "present/image/read.h"
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

// A row of unlit squares, each a unit wide, before the file's own camera.
GltfBuilder unlit_squares(const std::vector<std::array<int, 3>>& codes) {
    GltfBuilder file = quad_with_normal_map();
    file.root["extensionsUsed"] = {"KHR_materials_unlit"};
    file.root.erase("nodes");
    file.root["scenes"][0]["nodes"] = nlohmann::json::array();
    const nlohmann::json primitive = file.primitive();
    for (std::size_t i = 0; i < codes.size(); ++i) {
        nlohmann::json color = {1, 1, 1, 1};
        for (std::size_t c = 0; c < 3; ++c) {
            const double share = codes[i][c] / 255.0;
            color[c] = share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
        }
        nlohmann::json square = primitive;
        square["material"] = file.add(
            "materials", {{"pbrMetallicRoughness", {{"baseColorFactor", color}}},
                          {"extensions", {{"KHR_materials_unlit", nlohmann::json::object()}}}});
        file.add_node(
            {{"mesh", file.add("meshes", {{"primitives", {square}}})}, {"translation", {i, 0, 0}}});
    }
    const double half = 0.5 * static_cast<double>(codes.size());
    file.add("cameras",
             {{"type", "orthographic"},
              {"orthographic", {{"xmag", half}, {"ymag", 0.5}, {"znear", 0.1}, {"zfar", 10}}}});
    file.add_node({{"camera", 0}, {"translation", {half, 0.5, 5}}});
    return file;
}

TEST(SceneDefects, ColoursOfUnlitSurfacesStay) {
    constexpr int kSide = 16;
    const std::vector<std::array<int, 3>> codes = {{128, 128, 128}, {40, 40, 40},   {9, 9, 9},
                                                   {255, 0, 0},     {1, 2, 254},    {200, 128, 40},
                                                   {12, 77, 5},     {255, 255, 255}};
    const TemporaryFolder folder;
    const std::string scene = (folder / "squares.glb").string();
    const std::string picture = (folder / "a.png").string();
    write_file(scene, unlit_squares(codes).glb());
    const auto columns = static_cast<int>(codes.size());
    const ChildResult result =
        run_kilolux({"render", scene, "-o", picture, "--resolution",
                     std::to_string(columns * kSide) + "," + std::to_string(kSide)});
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(contains(result.err, "tonemap none (automatic)")) << result.err;
    const FloatImage image = read_image(picture);
    const std::vector<float> rgb = colour_of(image);
    ASSERT_EQ(image.width, columns * kSide);
    for (int i = 0; i < columns; ++i) {
        const auto pixel =
            static_cast<std::size_t>(kSide / 2 * image.width + i * kSide + kSide / 2);
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_EQ(std::lround(255.0f * rgb[3 * pixel + c]),
                      codes[static_cast<std::size_t>(i)][c])
                << "square " << i << ", channel " << c;
        }
    }
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

// Files that people reported, rendered as the program does by default.
class FoundScenes : public testing::Test {
 protected:
    void SetUp() override {
        if (!fs::exists(scenes() / "found")) GTEST_SKIP() << scenes() << " is not there";
    }

    FloatImage picture(const char* name, std::vector<std::string> more = {},
                       const char* format = "png") {
        const TemporaryFolder output;
        const std::string file = output / (std::string("a.") + format);
        std::vector<std::string> words = {"render", (scenes() / "found" / name).string(), "-o",
                                          file};
        words.insert(words.end(), more.begin(), more.end());
        if (std::ranges::find(more, "--resolution") == more.end()) {
            words.insert(words.end(), {"--resolution", "64,36"});
        }
        const ChildResult result = run_kilolux(words);
        EXPECT_EQ(result.code, 0) << result.err;
        said = result.err;
        return result.code == 0 ? read_image(file) : FloatImage{};
    }

    std::string said;  // of the last picture
};

// The columns of the middle row, and the rows of the middle column, that are not black.
std::pair<int, int> lit_extent(const FloatImage& image) {
    const std::vector<float> rgb = colour_of(image);
    const auto lit = [&](int x, int y) {
        return rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                        static_cast<std::size_t>(x))] > 0.0f;
    };
    std::pair<int, int> out = {0, 0};
    for (int x = 0; x < image.width; ++x) out.first += lit(x, image.height / 2) ? 1 : 0;
    for (int y = 0; y < image.height; ++y) out.second += lit(image.width / 2, y) ? 1 : 0;
    return out;
}

TEST_F(FoundScenes, AMugIsSeenFromOutsideInAStudio) {
    const FloatImage image = picture("j1_mug.glb");
    EXPECT_TRUE(contains("\n" + said, "\nview    outside (automatic)")) << said;
    EXPECT_TRUE(contains(said, "rig     studio (automatic)")) << said;
    const auto [width, height] = lit_extent(image);
    EXPECT_LT(width, image.width) << "the mug fills the picture, as its inside would";
    EXPECT_GT(height, image.height / 2);
}

TEST_F(FoundScenes, TheAutomaticCameraSeesTheTimeAskedForAndNothingHidden) {
    for (const auto& [name, time] : {std::pair{"n7.glb", "1"}, std::pair{"n7.glb", "0"},
                                     std::pair{"m7_hidden_by_zero_scale_far.glb", "0"}}) {
        const auto [width, height] = lit_extent(picture(name, {"--time", time}));
        EXPECT_GT(height, 18) << name << " at " << time << " is small or not there";
        EXPECT_GT(width, 18) << name << " at " << time;
        EXPECT_FALSE(contains(said, "picture is empty")) << said;
    }
}

TEST_F(FoundScenes, ANarrowPictureShowsTheWidthThatTheFilesCameraHas) {
    const FloatImage image = picture("d04.glb", {"--resolution", "120,160"});
    const auto [width, height] = lit_extent(image);
    EXPECT_NEAR(width, 120 * 1.2 / 4.0, 1.0) << "a camera of 90 degrees, a square at 4 m";
    EXPECT_NEAR(height, width, 1.0);
}

TEST_F(FoundScenes, ColoursOfUnlitSurfacesStay) {
    const FloatImage image = picture("n1.glb");
    ASSERT_EQ(image.width, 64);
    const std::vector<float> rgb = colour_of(image);
    const float* middle = &rgb[3 * (18 * 64 + 32)];
    EXPECT_EQ(middle[0], 1.0f);
    EXPECT_EQ(middle[1], 0.0f);
    EXPECT_EQ(middle[2], 0.0f);
    EXPECT_TRUE(contains(said, "tonemap none (automatic)")) << said;
}

TEST_F(FoundScenes, MessagesHaveAPlaceAndACause) {
    const std::pair<const char*, const char*> cases[] = {
        {"k2_gltf1.gltf", "asset.version is '1.0', must be 2.0"},
        {"k2_gltf1_num.gltf", "asset.version is '1', must be 2.0"},
        {"k2_skin_no_joints.gltf", "skins[0].joints is missing"}};
    for (const auto& [name, message] : cases) {
        expect_one_line((scenes() / "found" / name).string(), message);
    }
}

TEST_F(FoundScenes, MeshoptCompressionOfKhronosIsRead) {
    const Scene scene = load_scene(scenes() / "found/k_KHR_meshopt_compression_True.glb");
    EXPECT_EQ(triangle_count(scene), 2u);
    EXPECT_EQ(scene.still_box.min, glm::dvec3(-1, -1, -4));
}

TEST_F(FoundScenes, AHundredAndTwentyNineLightsWithoutARangeKeepTheirLight) {
    const auto light = [&](std::vector<std::string> more) {
        more.insert(more.end(), {"--ambient", "0"});
        double sum = 0.0;
        for (const float value : picture("q_tails_129.glb", more, "exr").values) {
            sum += double{value};
        }
        return sum;
    };
    const double exact = light({"--tails", "exact"});
    ASSERT_GT(exact, 0.0);
    EXPECT_NEAR(light({}) / exact, 1.0, 0.1);
}

}  // namespace
}  // namespace kilolux
