// SPDX-License-Identifier: Apache-2.0
// Scene files through the program: export and back, files outside the scene's folder.
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "present/image/read.h"
#include "tests/support/child.h"
#include "tests/support/environment_variable.h"
#include "tests/support/gltf_builder.h"
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
    EXPECT_TRUE(names_in(folder).empty());
}

// A colour that a designer chose for the screen is on the screen, unless a curve was asked for.
TEST(SceneFile, UnlitColoursAreShownAsTheyAre) {
    const TemporaryFolder folder;
    for (const int code : {40, 128, 230}) {
        const double light = std::pow((code / 255.0 + 0.055) / 1.055, 2.4);
        GltfBuilder file = triangle_file();
        file.root["extensionsUsed"] = {"KHR_materials_unlit"};
        file.root["materials"] = {
            {{"pbrMetallicRoughness", {{"baseColorFactor", {light, light, light, 1.0}}}},
             {"extensions", {{"KHR_materials_unlit", Json::object()}}}}};
        file.primitive()["material"] = 0;
        const std::string scene = (folder / "unlit.gltf").string();
        write_text(scene, file.gltf());
        const auto brightest = [&](const std::vector<std::string>& more) {
            const ChildResult result = render(scene, folder / "a.png", more);
            EXPECT_EQ(result.code, 0) << result.err;
            return std::lround(255.0 * std::ranges::max(read_image(folder / "a.png").values));
        };
        EXPECT_EQ(brightest({"--background", "0,0,0"}), code);
        EXPECT_LT(brightest({"--background", "0,0,0", "--tonemap", "neutral"}), code);
    }
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
    // Exporting renders nothing, so the bound holds for the loader alone.
    const auto export_within = [&](const char* bytes) {
        return run_kilolux(
            {"export", file, "-q", "--max-memory", bytes, "-o", (folder / "t.glb").string()});
    };
    EXPECT_EQ(export_within("64M").code, 0);
    const ChildResult refused = export_within("100K");
    EXPECT_EQ(refused.code, 1);
    EXPECT_TRUE(contains(refused.err, "s.glb: ")) << refused.err;
    EXPECT_TRUE(contains(refused.err, " MiB of 1 MiB are left (--max-memory)")) << refused.err;
}

// Lines, two clips, a variant, and an extension that is left out; all values are zeros.
std::string write_choices(const TemporaryFolder& folder) {
    const char* text = R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":1}]}],
"accessors":[{"componentType":5126,"type":"VEC3","count":4},
{"componentType":5126,"type":"SCALAR","count":4}],
"animations":[{"name":"walk","samplers":[{"input":1,"output":0}],"channels":[
{"sampler":0,"target":{"node":0,"path":"translation"}}]},{"name":"run","samplers":[
{"input":1,"output":0}],"channels":[{"sampler":0,"target":{"node":0,"path":"scale"}}]}],
"extensionsUsed":["KHR_materials_variants","KHR_materials_iridescence"],
"extensions":{"KHR_materials_variants":{"variants":[{"name":"night"}]}}})";
    write_text(folder / "choices.gltf", text);
    return (folder / "choices.gltf").string();
}

TEST(SceneFile, InfoListsClipsAndVariants) {
    const TemporaryFolder folder;
    const std::string file = write_choices(folder);
    const ChildResult json = run_kilolux({"info", file, "--json", "-q", "--clip", "run"});
    ASSERT_EQ(json.code, 0) << json.err;
    const Json scene = Json::parse(json.out).at("scene");
    EXPECT_EQ(scene.at("triangles"), 16) << "two lines";
    ASSERT_EQ(scene.at("animations").size(), 2u);
    EXPECT_EQ(scene.at("animations")[1].at("name"), "run");
    EXPECT_EQ(scene.at("animations")[1].at("index"), 1);
    EXPECT_EQ(scene.at("animations")[1].at("channels"), 1);
    EXPECT_EQ(scene.at("animations")[1].at("length_s"), 0.0);
    EXPECT_EQ(scene.at("animations")[1].at("plays"), true);
    EXPECT_EQ(scene.at("animations")[0].at("plays"), false);
    EXPECT_EQ(scene.at("variants"), Json({"night"}));
    const ChildResult text = run_kilolux({"info", file, "-q"});
    EXPECT_TRUE(contains(text.out, "    - 0 'walk': 0 s, 1 channels, plays\n")) << text.out;
    EXPECT_TRUE(contains(text.out, "    - night\n")) << text.out;
}

TEST(SceneFile, ChoicesThatItDoesNotHaveAreOneLine) {
    const TemporaryFolder folder;
    const std::string file = write_choices(folder);
    const auto export_with = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words = {
            "export", file, "-q", "--lights", "0", "-o", (folder / "t.glb").string()};
        words.insert(words.end(), more.begin(), more.end());
        return run_kilolux(words);
    };
    EXPECT_EQ(export_with({"--clip", "all", "--variant", "night"}).code, 0);
    const ChildResult clip = export_with({"--clip", "wlak"});
    EXPECT_EQ(clip.code, 2);
    EXPECT_TRUE(contains(clip.err, "did you mean 'walk'?")) << clip.err;
    EXPECT_EQ(export_with({"--variant", "day"}).code, 2);
    EXPECT_EQ(export_with({"--clip", "walk,,run"}).code, 2);
    EXPECT_EQ(export_with({"--line-width", "0%"}).code, 2);
    const ChildResult strict = export_with({"--strict"});
    EXPECT_EQ(strict.code, 1);
    EXPECT_TRUE(contains(strict.err, "--strict: left out: KHR_materials_iridescence"))
        << strict.err;
    const ChildResult generated = run_kilolux({"info", "grid", "--variant", "night"});
    EXPECT_EQ(generated.code, 2);
    EXPECT_TRUE(contains(generated.err, "--variant: grid is a generated scene")) << generated.err;
}

TEST(Info, TellsInStatsWhatLeftOutFeaturesWouldCost) {
    const TemporaryFolder folder;
    const EnvironmentVariable cache("XDG_CACHE_HOME", folder.path().string());
    const std::vector<std::string> words = {"--resolution", "64,36", "--lights", "20"};
    std::vector<std::string> info = {"info", "plain", "--json"};
    info.insert(info.end(), words.begin(), words.end());
    const ChildResult listed = run_kilolux(info);
    ASSERT_EQ(listed.code, 0) << listed.err;
    std::vector<std::string> more = words;
    more.insert(more.end(), {"--stats", "-"});
    const ChildResult stats = render("plain", folder / "a.png", more);
    const Json left_out = Json::parse(listed.out).at("left_out");
    EXPECT_EQ(Json::parse(stats.out).at("left_out"), left_out);
    bool saw = false;
    for (const Json& entry : left_out) {
        EXPECT_TRUE(entry.at("bytes_per_pixel").is_number()) << entry;
        if (entry.at("name") != "spot-lights") continue;
        saw = true;
        EXPECT_TRUE(entry.at("ms").is_null()) << entry;
    }
    EXPECT_TRUE(saw);
}

}  // namespace
}  // namespace kilolux
