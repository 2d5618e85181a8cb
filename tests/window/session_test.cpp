// SPDX-License-Identifier: Apache-2.0
// Uses `kilolux view` like a user: real window, real events, pictures of the screen. Under Xvfb.
#include <gtest/gtest.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "host/picture/views.h"
#include "present/cli/names.h"
#include "present/window/script/script.h"
#include "present/window/script/script_player.h"
#include "tests/support/paths.h"
#include "tests/window/expected_picture.h"
#include "tests/window/scripted_window.h"

namespace kilolux {
namespace {

TEST(Window, ShowsThePictureOfEveryRenderer) {
    const TemporaryFolder folder;
    Script script(folder);
    for (const std::string& name : names_of<RendererKind>()) {
        script.line("choose renderer " + name).shot(name);
    }
    play(script);
    ExpectedPicture expected;
    for (int i = 0; const std::string& name : names_of<RendererKind>()) {
        const auto renderer = static_cast<RendererKind>(i++);
        expect_same_picture(folder / (name + ".png"),
                            expected.of([&](RenderSettings& s) { s.renderer = renderer; }));
    }
    EXPECT_EQ(mean_difference(scene_part(folder / "deferred.png"),
                              scene_part(folder / "deferred-all.png")),
              0.0);
}

TEST(Window, ShowsEveryView) {
    const TemporaryFolder folder;
    Script script(folder);
    std::vector<std::string> names = view_names();
    std::erase(names, "shadows");  // takes --shadows exact
    for (const std::string& name : names) {
        script.line("choose show " + name).line("away").shot(name);
    }
    play(script);
    ExpectedPicture expected;
    for (const std::string& name : names) {
        expect_same_picture(folder / (name + ".png"), expected.of([&](RenderSettings& s) {
            s.want.view = parse_view(name);
        }));
    }
}

TEST(Window, SlidersAndTextReachThePicture) {
    const TemporaryFolder folder;
    Script script(folder);
    script.line("slide exposure -4").shot("dark").line("type exposure 0");
    script.line("slide lights 20000").line("away").shot("lights");
    script.line("type lights 150").line("choose tone map aces").line("away").shot("aces");
    script.line("slide bloom 0.6").line("away").shot("bloom");
    play(script);
    ExpectedPicture expected;
    const auto expect = [&](const char* name, const std::function<void(RenderSettings&)>& change) {
        expect_same_picture(folder / (std::string(name) + ".png"), expected.of(change));
    };
    expect("dark", [](RenderSettings& s) { s.exposure = -4.0f; });
    expect("lights", [](RenderSettings& s) { s.lights.count = 20000; });
    expect("aces", [](RenderSettings& s) { s.tone_curve = ToneCurve::aces; });
    expect("bloom", [](RenderSettings& s) {
        s.tone_curve = ToneCurve::aces;
        s.bloom = 0.6f;
    });
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

TEST(Window, MeasuresItsErrorAndShowsAMap) {
    const TemporaryFolder folder;
    Script script(folder);
    script.shot("start")
        .line("open error")
        .line("click measure error")
        .line("away")
        .shot("measured");
    script.line("click error map")
        .line("away")
        .shot("map")
        .line("type exposure 1")
        .line("away")
        .shot("other");
    play(script);
    const ScenePart start = scene_part(folder / "start.png");
    EXPECT_EQ(mean_difference(start, scene_part(folder / "measured.png")), 0.0);
    // The heat map's colours and nothing else: green never exceeds both red and blue.
    const ScenePart map = scene_part(folder / "map.png");
    std::set<std::array<float, 3>> colours;
    int green = 0;
    for (std::size_t i = 0; i + 2 < map.values.size(); i += 3) {
        const float r = map.values[i], g = map.values[i + 1], b = map.values[i + 2];
        colours.insert({r, g, b});
        green += g > std::max(r, b) + 0.02f;
    }
    EXPECT_EQ(green, 0);
    EXPECT_GT(colours.size(), 20u);
    EXPECT_GT(mean_difference(start, map), 0.05);
    // The error map belongs to the measured picture; any other picture is shown itself.
    ExpectedPicture expected;
    expect_same_picture(folder / "other.png",
                        expected.of([](RenderSettings& s) { s.exposure = 1.0f; }));
}

TEST(Window, NoticesFade) {
    const TemporaryFolder folder;
    Script script(folder);
    script.shot("start").line("key C 0").line("frames 9").shot("notice");
    script.line("frames 200").shot("faded");
    play(script);
    const std::array<int, 4> overlay = {360, 0, 340, kUnderlay};
    EXPECT_GT(changes(folder / "start.png", folder / "notice.png", overlay).changed, 500);
    EXPECT_EQ(changes(folder / "start.png", folder / "faded.png", overlay).changed, 0);
}

TEST(Window, SettlingWhileTheLightsMoveEndsWithAMessage) {
    const TemporaryFolder folder;
    Script script(folder);
    script.line("key Space 0").line("settle");
    const ChildResult result = view_in_display({}, small_window(script.write()));
    EXPECT_EQ(result.code, 1) << result.err;
    EXPECT_NE(result.err.find("script:2"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("lights move"), std::string::npos) << result.err;
}

TEST(Window, SettlesWhileItRendersAlways) {
    const TemporaryFolder folder;
    Script script(folder);
    // With the panel's chart in sight, to which every picture adds a bar.
    const auto later = [&](const std::string& name) {
        script.line("open speed").line("wheel -4").line("away").shot(name).line("frames 60");
        script.line("screenshot " + (folder / (name + "-later.png")).string());
    };
    later("rest");
    script.line("open window").line("click render always").line("away");
    script.line("type exposure 1").line("away");
    later("shown");
    play(script);
    const std::array<int, 4> panel = {0, 0, kPanel, 420};
    EXPECT_EQ(changes(folder / "rest.png", folder / "rest-later.png", panel).changed, 0);
    EXPECT_GT(changes(folder / "shown.png", folder / "shown-later.png", panel).changed, 0);
    ExpectedPicture expected;
    expect_same_picture(folder / "shown.png",
                        expected.of([](RenderSettings& s) { s.exposure = 1.0f; }));
}

// At rest the picture gets one sample after the other, and has the bits of `render --samples`; any
// movement begins it anew.
TEST(Window, RefinesItsPictureAtRest) {
    const TemporaryFolder folder;
    Script script(folder);
    script.shot("first").line("drag 500 300 560 320").line("frames 2").shot("turned");
    script.line("key R 0").shot("again");
    script.line("choose show albedo").shot("albedo");
    auto words = small_window(script.write());
    words.insert(words.end(), {"--samples", "4"});
    const ChildResult result = view_in_display({}, words);
    ASSERT_EQ(result.code, 0) << result.err;
    ExpectedPicture expected;
    const auto four = [](RenderSettings& s) { s.samples = 4; };
    expect_same_picture(folder / "first.png", expected.of(four));
    expect_same_picture(folder / "again.png", expected.of(four));
    EXPECT_GT(mean_difference(scene_part(folder / "first.png"), expected.of()), 1e-4);
    EXPECT_GT(mean_difference(scene_part(folder / "turned.png"), expected.of(four)), 1e-2);
    expect_same_picture(folder / "albedo.png",
                        expected.of([](RenderSettings& s) { s.want.view = ViewKind::albedo; }));
}

TEST(Window, KeepsItsValues) {
    const TemporaryFolder folder;
    const std::string config = "XDG_CONFIG_HOME=" + folder.path().string();
    Script script(folder);
    script.line("type lights 77").line("choose show normal").line("resize 690 410").line("settle");
    auto words = small_window(script.write());
    std::erase(words, "--fresh");
    words.insert(words.end(), {"--exposure", "1"});
    ASSERT_EQ(view_in_display({config}, words).code, 0);
    const auto kept = nlohmann::json::parse(text_of_file(folder / "kilolux" / "view.json"));
    EXPECT_EQ(kept.at("lights"), 77);
    EXPECT_EQ(kept.at("show"), "normal");
    EXPECT_EQ(kept.at("exposure"), 0.0) << "from the command line, not changed in the window";
    const std::string again = (folder / "again.png").string();
    const ChildResult result = view_in_display(
        {config}, {"view", "plain", "-q", "--exit-after", "2", "--screenshot", again});
    ASSERT_EQ(result.code, 0) << result.err;
    // A view of normals differs from the lit picture: blue is never 0 on surfaces that face the
    // camera.
    EXPECT_GT(mean_of(scene_part(again)), 0.1);
    EXPECT_EQ(read_image(again).width, 690);
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
    const std::vector<std::string> changes = {
        "type lights 77", "choose show normal", "choose tone map aces", "choose rig studio",
        "settle",  // results move the panel's buttons
        "open window",    "click vsync"};
    std::vector<std::string> changes_and_back = changes;
    changes_and_back.emplace_back("settle");
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
    for (const auto& [text, word] :
         std::map<std::string, std::string>{{"clik vsync", "click"},
                                            {"drag 1 2", "drag"},
                                            {"key Hyper 1", "Hyper"},
                                            {"key Hyper+V 1", "Hyper"}}) {
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
    write_text(folder / "script", "slide lights 2000000\n");
    const ChildResult beyond = view_in_display({}, small_window((folder / "script").string()));
    EXPECT_EQ(beyond.code, 1) << beyond.err;
    EXPECT_NE(beyond.err.find("1 to 1000000"), std::string::npos) << beyond.err;
}

}  // namespace
}  // namespace kilolux
