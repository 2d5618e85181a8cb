// SPDX-License-Identifier: Apache-2.0
// `kilolux view` as a person uses it: real window, real events, pictures of the screen. Under Xvfb.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "host/picture/views.h"
#include "present/cli/names.h"
#include "tests/support/paths.h"
#include "tests/window/scripted_window.h"

namespace kilolux {
namespace {

// Goes through a session and expects that neither OpenGL, OpenCL nor the program complains: what
// fails while a script plays ends it with a message.
void play(const Script& script) {
    const ChildResult result = view_in_display({}, small_window(script.write()));
    ASSERT_EQ(result.code, 0) << result.err << result.out;
    EXPECT_EQ(result.err, "");
}

TEST(Window, MovesTheCameraByKeysAndMouse) {
    const TemporaryFolder folder;
    Script script(folder);
    script.shot("start").shot("again");
    script.line("key W 0.4").shot("forward");
    script.line("drag 450 250 530 280").shot("looked");
    script.line("key R 0").shot("reset");
    script.line("key O 0").line("drag 450 250 520 250").shot("orbited");
    script.line("wheel 4").shot("zoomed");
    script.line("key F 0").shot("framed");
    play(script);
    std::map<std::string, ScenePart> parts;
    for (const char* name :
         {"start", "again", "forward", "looked", "reset", "orbited", "zoomed", "framed"}) {
        parts[name] = scene_part(folder / (std::string(name) + ".png"));
        EXPECT_GT(mean_of(parts[name]), 0.01) << name;
    }
    EXPECT_EQ(mean_difference(parts["start"], parts["again"]), 0.0);
    EXPECT_EQ(mean_difference(parts["start"], parts["reset"]), 0.0);
    EXPECT_GT(mean_difference(parts["start"], parts["forward"]), 0.005);
    EXPECT_GT(mean_difference(parts["forward"], parts["looked"]), 0.005);
    EXPECT_GT(mean_difference(parts["reset"], parts["orbited"]), 0.005);
    EXPECT_GT(mean_difference(parts["orbited"], parts["zoomed"]), 0.005);
    EXPECT_GT(mean_difference(parts["zoomed"], parts["framed"]), 0.005);
}

TEST(Window, EveryRendererShowsTheSamePicture) {
    const TemporaryFolder folder;
    Script script(folder);
    for (const std::string& name : renderer_names()) {
        script.line("choose renderer " + name).shot(name);
    }
    play(script);
    const ScenePart deferred = scene_part(folder / "deferred.png");
    EXPECT_EQ(mean_difference(deferred, scene_part(folder / "deferred-all.png")), 0.0);
    EXPECT_LT(mean_difference(deferred, scene_part(folder / "forward.png")), 0.01);
    EXPECT_LT(mean_difference(deferred, scene_part(folder / "forward-plus.png")), 0.01);
}

TEST(Window, EveryViewIsAPictureOfItsOwn) {
    const TemporaryFolder folder;
    Script script(folder);
    for (const std::string& name : view_names()) script.line("choose show " + name).shot(name);
    play(script);
    for (const std::string& a : view_names()) {
        for (const std::string& b : view_names()) {
            if (a >= b) continue;
            EXPECT_GT(mean_difference(scene_part(folder / (a + ".png")),
                                      scene_part(folder / (b + ".png"))),
                      0.001)
                << a << " and " << b;
        }
    }
}

TEST(Window, SlidersAndTextReachThePicture) {
    const TemporaryFolder folder;
    Script script(folder);
    script.shot("start");
    script.line("slide exposure -4").shot("dark");
    script.line("type exposure 0").shot("back");
    script.line("slide lights 20000").line("move 20 410").shot("lights");
    script.line("type lights 150").line("move 20 410").shot("typed");
    script.line("choose tone map aces").shot("aces");
    script.line("slide bloom 0.6").shot("bloom");
    play(script);
    const ScenePart start = scene_part(folder / "start.png");
    EXPECT_LT(mean_of(scene_part(folder / "dark.png")), 0.6 * mean_of(start));
    EXPECT_EQ(mean_difference(start, scene_part(folder / "back.png")), 0.0);
    EXPECT_GT(mean_difference(start, scene_part(folder / "lights.png")), 0.005);
    EXPECT_EQ(mean_difference(start, scene_part(folder / "typed.png")), 0.0);
    EXPECT_GT(mean_difference(start, scene_part(folder / "aces.png")), 0.002);
    EXPECT_GT(mean_difference(scene_part(folder / "aces.png"), scene_part(folder / "bloom.png")),
              0.002);
}

TEST(Window, ResizesAndHidesItsPanel) {
    const TemporaryFolder folder;
    Script script(folder);
    script.shot("start").line("resize 820 500").shot("large").line("resize 620 380").shot("small");
    script.line("key Tab 0").shot("bare").line("key H 0").line("frames 3").shot("help");
    play(script);
    EXPECT_EQ(scene_part(folder / "start.png").width, 700);
    EXPECT_EQ(scene_part(folder / "large.png").width, 820);
    EXPECT_EQ(scene_part(folder / "large.png").height, 500);
    EXPECT_EQ(scene_part(folder / "small.png").height, 380);
    const auto left_of = [](const fs::path& file) { return scene_part(file, 0); };
    EXPECT_GT(mean_difference(left_of(folder / "small.png"), left_of(folder / "bare.png")), 0.01);
    EXPECT_GT(mean_difference(left_of(folder / "bare.png"), left_of(folder / "help.png")), 0.01);
}

TEST(Window, LooksIntoClusters) {
    const TemporaryFolder folder;
    Script script(folder);
    script.shot("start").line("key X 0").line("move 480 330").shot("probed").line("key X 0");
    script.shot("after").line("key G 0").shot("frozen").line("key S 0.3").shot("flown");
    script.line("key G 0").shot("thawed");
    play(script);
    const ScenePart start = scene_part(folder / "start.png");
    EXPECT_GT(mean_difference(start, scene_part(folder / "probed.png")), 0.005);
    EXPECT_EQ(mean_difference(start, scene_part(folder / "after.png")), 0.0);
    EXPECT_GT(mean_difference(start, scene_part(folder / "frozen.png")), 0.005);
    EXPECT_GT(mean_difference(scene_part(folder / "flown.png"), scene_part(folder / "thawed.png")),
              0.002);
}

TEST(Window, MeasuresItsErrorAndBenchmarks) {
    const TemporaryFolder folder;
    Script script(folder);
    script.shot("start")
        .line("open error")
        .line("click measure error")
        .line("frames 4")
        .shot("error");
    script.line("open benchmark").line("type most lights 256").line("click run benchmark");
    script.line("frames 4").shot("bench");
    const fs::path before = fs::current_path();
    fs::current_path(folder.path());
    play(script);
    fs::current_path(before);
    const std::string csv = text_of_file(folder / "kilolux-001-bench.csv");
    EXPECT_NE(csv.find("forward-plus"), std::string::npos) << csv;
    const auto panel = [&](const char* name) {
        ScenePart whole = scene_part(folder / name, 0);
        return whole;
    };
    EXPECT_GT(mean_difference(panel("start.png"), panel("error.png")), 0.001);
}

TEST(Window, KeepsItsValues) {
    const TemporaryFolder folder;
    const std::string config = "XDG_CONFIG_HOME=" + folder.path().string();
    Script script(folder);
    script.line("type lights 77").line("choose show normal").line("settle");
    auto words = small_window(script.write());
    std::erase(words, "--fresh");
    ASSERT_EQ(view_in_display({config}, words).code, 0);
    const auto kept = nlohmann::json::parse(text_of_file(folder / "kilolux" / "view.json"));
    EXPECT_EQ(kept.at("lights"), 77);
    EXPECT_EQ(kept.at("show"), "normal");
    const std::string again = (folder / "again.png").string();
    const ChildResult result = view_in_display(
        {config}, {"view", "plain", "-q", "--exit-after", "2", "--screenshot", again});
    ASSERT_EQ(result.code, 0) << result.err;
    // A view of normals is nothing like the lit picture: blue is never 0 on what faces the camera.
    EXPECT_GT(mean_of(scene_part(again)), 0.1);
    EXPECT_EQ(read_image(again).width, 700);
}

TEST(Window, GoesBackToItsDefaults) {
    const auto kept_after = [](const std::vector<std::string>& lines) {
        const TemporaryFolder folder;
        Script script(folder);
        script.line("settle");
        for (const std::string& line : lines) script.line(line);
        const ChildResult result = view_in_display(
            {"XDG_CONFIG_HOME=" + folder.path().string()},
            {"view", "plain", "-q", "--resolution", "700,420", "--script", script.write()});
        EXPECT_EQ(result.code, 0) << result.err;
        return nlohmann::json::parse(text_of_file(folder / "kilolux" / "view.json"));
    };
    const std::vector<std::string> changes = {"type lights 77", "choose show normal",
                                              "choose tone map aces", "open window", "click vsync"};
    std::vector<std::string> changes_and_back = changes;
    changes_and_back.emplace_back("click all settings to their defaults");
    changes_and_back.emplace_back("settle");
    const auto untouched = kept_after({"frames 1"});
    EXPECT_NE(kept_after(changes), untouched);
    EXPECT_EQ(kept_after(changes_and_back), untouched);
}

TEST(Window, SaysInOneLineWhatIsMissing) {
    const auto one_line = [](const ChildResult& result, const std::string& word) {
        EXPECT_EQ(result.code, 1) << result.err;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
    };
    const std::vector<std::string> words = {"/usr/bin/env", "-uDISPLAY", "-uWAYLAND_DISPLAY",
                                            program_file(), "view",      "plain",
                                            "--fresh"};
    one_line(run_child(words), "kilolux render");
    const std::vector<std::string> view = {"view", "plain", "--fresh", "-q", "--exit-after", "1"};
    one_line(view_in_display({"MESA_GL_VERSION_OVERRIDE=3.3"}, view), "libgl1-mesa-dri");
    one_line(view_in_display({"OCL_ICD_VENDORS=/nonexistent"}, view), "pocl-opencl-icd");
}

TEST(Window, ScriptsSayWhatTheyDoNotUnderstand) {
    const TemporaryFolder folder;
    for (const auto& [text, word] : std::map<std::string, std::string>{
             {"clik vsync", "click"}, {"drag 1 2", "drag"}, {"key Hyper 1", "Hyper"}}) {
        write_text(folder / "script", text + "\n");
        const ChildResult result = view_in_display({}, small_window((folder / "script").string()));
        EXPECT_EQ(result.code, 2) << result.err;
        EXPECT_NE(result.err.find("script:1"), std::string::npos) << result.err;
        EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
    }
    write_text(folder / "script", "click nonsense\n");
    const ChildResult result = view_in_display({}, small_window((folder / "script").string()));
    EXPECT_EQ(result.code, 1) << result.err;
    EXPECT_NE(result.err.find("nonsense"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace kilolux
