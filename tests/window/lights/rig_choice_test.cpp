// SPDX-License-Identifier: Apache-2.0
// The panel's choice of the light rig: the window shows what `kilolux render --rig` makes.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/lit_hall.h"
#include "tests/window/scripted_window.h"

namespace kilolux {
namespace {

std::vector<std::string> words_of(const Script& script) {
    return {"view",      "plain", "-q",       "--resolution", "700,420",
            "--samples", "1",     "--script", script.write()};
}

TEST(WindowRig, ShowsThePictureOfEveryRig) {
    const TemporaryFolder folder;
    Script script(folder);
    script.shot("start");
    const std::vector<std::string> order = {"studio", "none", "headlight", "swarm", "none", "auto"};
    for (const std::string& name : order) script.line("choose rig " + name).line("away").shot(name);
    const ChildResult result = view_in_display({}, small_window(script.write()));
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    const auto expect = [&](const std::string& name, const std::vector<std::string>& options) {
        const ScenePart seen = scene_part(folder / (name + ".png"));
        EXPECT_EQ(seen.values, rendered(folder / "rendered.png", options).values) << name;
    };
    expect("studio", {"--rig", "studio"});
    expect("none", {"--rig", "none"});
    expect("headlight", {"--rig", "headlight"});
    for (const char* name : {"start", "swarm", "auto"}) expect(name, {"--lights", "150"});
    const ScenePart studio = scene_part(folder / "studio.png");
    EXPECT_GT(mean_difference(studio, scene_part(folder / "headlight.png")), 0.01);
    EXPECT_GT(mean_difference(studio, scene_part(folder / "auto.png")), 0.01);
}

// The lights of an environment stay beside those of any rig.
TEST(WindowRig, KeepsTheEnvironment) {
    const TemporaryFolder folder;
    Script script(folder);
    script.shot("start").line("choose rig headlight").line("away").shot("headlight");
    auto words = words_of(script);
    words.insert(words.end(), {"--fresh", "--environment", "sky", "--environment-lights", "7"});
    const ChildResult result = view_in_display({}, words);
    ASSERT_EQ(result.code, 0) << result.err;
    std::vector<std::string> options = {"--environment", "sky", "--environment-lights", "7"};
    EXPECT_EQ(scene_part(folder / "start.png").values,
              rendered(folder / "rendered.png", options).values);
    options.insert(options.end(), {"--rig", "headlight"});
    EXPECT_EQ(scene_part(folder / "headlight.png").values,
              rendered(folder / "rendered.png", options).values);
}

TEST(WindowRig, IsKeptUnlessTheCommandLineSaysSomethingOfLights) {
    const TemporaryFolder folder;
    const fs::path file = folder / "kilolux" / "view.json";
    const auto play = [&](const Script& script, const std::vector<std::string>& more) {
        auto words = words_of(script);
        words.insert(words.end(), more.begin(), more.end());
        const ChildResult result =
            view_in_display({"XDG_CONFIG_HOME=" + folder.path().string()}, words);
        EXPECT_EQ(result.code, 0) << result.err;
        return nlohmann::json::parse(text_of_file(file));
    };
    Script first(folder);
    const auto kept =
        play(first.line("choose rig studio").line("settle").line("type lights 3"), {});
    EXPECT_EQ(kept.at("rig"), "studio");
    EXPECT_EQ(kept.at("lights"), 3);
    EXPECT_FLOAT_EQ(kept.at("ambient").get<float>(), 0.2f);
    Script again(folder);
    EXPECT_EQ(play(again.shot("again"), {}), kept);
    EXPECT_EQ(scene_part(folder / "again.png").values,
              rendered(folder / "rendered.png", {"--rig", "studio", "--lights", "3"}).values);
    Script other(folder);
    EXPECT_EQ(play(other.shot("lights"), {"--lights", "150"}), kept);
    EXPECT_EQ(scene_part(folder / "lights.png").values,
              rendered(folder / "rendered.png", {"--lights", "150"}).values);
    EXPECT_EQ(play(other.shot("rig"), {"--rig", "headlight"}), kept);
    EXPECT_EQ(scene_part(folder / "rig.png").values,
              rendered(folder / "rendered.png", {"--rig", "headlight"}).values);
}

// Shadows need other tails than a picture without them: see choose_tails().
TEST(WindowRig, AutomaticTailsFollowTheShadows) {
    const TemporaryFolder folder;
    const fs::path hall = folder / "hall.glb";
    write_scene(lit_hall(200, 1.0f), hall);
    Script script(folder);
    script.shot("start").line("choose shadows exact").line("away").shot("exact");
    script.line("choose shadows off").line("away").shot("off");
    auto words = words_of(script);
    words[1] = hall.string();
    words.emplace_back("--fresh");
    const ChildResult result = view_in_display({}, words);
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    const auto expect = [&](const std::string& name, const std::vector<std::string>& options) {
        const fs::path file = folder / "rendered.png";
        EXPECT_EQ(scene_part(folder / (name + ".png")).values,
                  rendered(file, options, hall.string()).values)
            << name;
    };
    expect("start", {});
    expect("exact", {"--shadows", "exact"});
    expect("off", {});
}

// Actions during the replacement of lights wait for it.
TEST(WindowRig, SavesThePictureOfTheChosenRig) {
    const TemporaryFolder folder;
    Script script(folder);
    script.line("settle").line("choose rig headlight").line("key P 0").line("settle");
    auto words = words_of(script);
    words.emplace_back("--fresh");
    const ChildResult result = view_in_display({"--chdir=" + folder.path().string()}, words);
    ASSERT_EQ(result.code, 0) << result.err;
    ASSERT_TRUE(fs::exists(folder / "kilolux-001.png"));
    EXPECT_EQ(scene_part(folder / "kilolux-001.png", 0).values,
              rendered(folder / "rendered.png", {"--rig", "headlight"}).values);
}

}  // namespace
}  // namespace kilolux
