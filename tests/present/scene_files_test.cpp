// SPDX-License-Identifier: Apache-2.0
// Scene files through the program: export and back, files outside the scene's folder.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "present/image/image_file.h"
#include "tests/support/child.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

using Json = nlohmann::json;

ChildResult render(const std::string& scene, const std::filesystem::path& file,
                   std::vector<std::string> more) {
    std::vector<std::string> words = {"render", scene, "-q",         "--resolution",
                                      "64,36",  "-o",  file.string()};
    words.insert(words.end(), more.begin(), more.end());
    return run_kilolux(words);
}

TEST(Export, ReadsBackToTheSamePicture) {
    const TemporaryFolder folder;
    for (const char* name : {"grid.glb", "grid.gltf"}) {
        const std::string file = (folder / name).string();
        const ChildResult result = run_kilolux({"export", "grid", "--lights", "60", "--time", "1.5",
                                                "--resolution", "64,36", "-o", file});
        ASSERT_EQ(result.code, 0) << result.err;
        EXPECT_TRUE(contains(result.err, "lights  ")) << result.err;
        EXPECT_EQ(result.out, "");
        const ChildResult before =
            render("grid", folder / "a.exr", {"--lights", "60", "--time", "1.5"});
        const ChildResult after = render(file, folder / "b.exr", {"--lights", "0"});
        ASSERT_EQ(before.code + after.code, 0) << before.err << after.err;
        EXPECT_EQ(read_image(folder / "a.exr").values, read_image(folder / "b.exr").values) << name;
    }
}

TEST(Export, RefusesWhatIsNoSceneFile) {
    const TemporaryFolder folder;
    const ChildResult wrong = run_kilolux({"export", "grid", "-o", (folder / "a.obj").string()});
    EXPECT_EQ(wrong.code, 2);
    EXPECT_TRUE(contains(wrong.err, "none of .glb, .gltf")) << wrong.err;
    EXPECT_EQ(run_kilolux({"export", "grid"}).code, 2);
    EXPECT_EQ(run_kilolux({"export", "grid", "-o", (folder / "no/a.glb").string()}).code, 1);
    EXPECT_TRUE(folder.names().empty());
}

TEST(SceneFile, LeavesItsFolderOnlyWithPermission) {
    const TemporaryFolder folder;
    const std::string exported = (folder / "s.gltf").string();
    ASSERT_EQ(run_kilolux({"export", "corridor", "--lights", "3", "-q", "-o", exported}).code, 0);
    std::filesystem::create_directory(folder / "inner");
    Json root = Json::parse(text_of_file(exported));
    root["buffers"][0]["uri"] = "../s.bin";
    const std::string inner = (folder / "inner/s.gltf").string();
    write_text(inner, root.dump());
    const ChildResult refused = render(inner, folder / "a.png", {});
    EXPECT_EQ(refused.code, 1);
    EXPECT_TRUE(contains(refused.err, "--allow-outside-paths")) << refused.err;
    const ChildResult allowed = render(inner, folder / "a.png", {"--allow-outside-paths"});
    EXPECT_EQ(allowed.code, 0) << allowed.err;
}

TEST(SceneFile, LoadsWithinTheBoundOfMemory) {
    const TemporaryFolder folder;
    const std::string file = (folder / "s.glb").string();
    ASSERT_EQ(run_kilolux({"export", "grid", "-q", "-o", file}).code, 0);
    // Exporting renders nothing, so that only the loader has a bound.
    const auto export_within = [&](const char* bytes) {
        return run_kilolux(
            {"export", file, "-q", "--max-memory", bytes, "-o", (folder / "t.glb").string()});
    };
    EXPECT_EQ(export_within("64M").code, 0);
    const ChildResult refused = export_within("100K");
    EXPECT_EQ(refused.code, 1);
    EXPECT_TRUE(contains(refused.err, "s.glb: ")) << refused.err;
    EXPECT_TRUE(contains(refused.err, "for buffers, images and meshes are left (--max-memory)"))
        << refused.err;
}

TEST(Info, TellsWhatLeftOutFeaturesWouldCost) {
    const TemporaryFolder folder;
    setenv("XDG_CACHE_HOME", folder.path().c_str(), 1);
    const std::vector<std::string> words = {"info",  "plain",    "--json", "--resolution",
                                            "64,36", "--lights", "20"};
    const auto left_out = [](const ChildResult& result) {
        return Json::parse(result.out).at("left_out");
    };
    const ChildResult before = run_kilolux(words);
    ASSERT_EQ(before.code, 0) << before.err;
    std::vector<std::string> measuring = words;
    measuring.push_back("--costs");
    const ChildResult measured = run_kilolux(measuring);
    ASSERT_EQ(measured.code, 0) << measured.err;
    const ChildResult stats = render("plain", folder / "a.png",
                                     {"--resolution", "64,36", "--lights", "20", "--stats", "-"});
    unsetenv("XDG_CACHE_HOME");
    bool saw = false;
    for (const Json& entry : left_out(before)) {
        EXPECT_TRUE(entry.at("bytes_per_pixel").is_number()) << entry;
        if (entry.at("name") != "spot-lights") continue;
        saw = true;
        EXPECT_TRUE(entry.at("ms").is_null()) << entry;
    }
    EXPECT_TRUE(saw);
    EXPECT_EQ(Json::parse(stats.out).at("left_out"), left_out(before));
    for (const Json& entry : left_out(measured)) {
        const std::string name = entry.at("name");
        EXPECT_TRUE(name != "spot-lights" || entry.at("ms").is_number()) << entry;
        EXPECT_TRUE(name != "specular" || entry.at("bytes_per_pixel") == 4) << entry;
    }
}

}  // namespace
}  // namespace kilolux
