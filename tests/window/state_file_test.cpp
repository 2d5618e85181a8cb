// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/state_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

bool nothing_given(const std::string&) { return false; }

ViewState unusual_state() {
    ViewState state;
    state.settings.renderer = RendererKind::forward_plus;
    state.settings.shading = Shading::lambert;
    state.settings.gbuffer = GBUFFER_HALF;
    state.settings.want.view = ViewKind::slices;
    state.settings.exposure = -1.3f;
    state.settings.tone_curve = ToneCurve::aces;
    state.settings.bloom = 0.1f;
    state.settings.shadows = Shadows::exact;
    state.settings.tails = Tails::tree;
    state.settings.tree_share = 0.25f;
    state.settings.kernels.lanes = 4;
    state.settings.lights.count = 123456;
    state.settings.lights.radius = 0.1;
    state.settings.lights.size = 0.05;
    state.settings.grid = {20, 11, 8, 32};
    state.rig = Rig::headlight;
    state.emissive_lights = EmissiveLights::on;
    state.lights_move = true;
    state.light_speed = 2.5;
    state.camera_mode = CameraMode::orbit;
    state.adaptive = false;
    state.fixed_scale = 0.5;
    state.vsync = false;
    state.window_size = {640, 480};
    return state;
}

ViewState loaded(const fs::path& file, const ViewState& state = {}) {
    return StateFile(file).load(state, nothing_given);
}

// A run of the window that begins with the command line's values, and ends with others.
void run(const fs::path& file, const ViewState& command_line, const std::set<std::string>& given,
         const std::function<void(ViewState&)>& change) {
    StateFile state_file(file);
    ViewState state = state_file.load(
        command_line, [&](const std::string& option) { return given.contains(option); });
    change(state);
    state_file.save(state);
}

TEST(StateFile, ComesBackAsItWas) {
    const TemporaryFolder folder;
    const auto file = folder / "new" / "folder" / "view.json";
    run(file, {}, {}, [](ViewState& state) { state = unusual_state(); });
    EXPECT_EQ(loaded(file), unusual_state());
}

TEST(StateFile, EveryValueThatTheCommandLineTakesComesBack) {
    const TemporaryFolder folder;
    const auto file = folder / "view.json";
    ViewState large;
    large.settings.lights.count = std::uint64_t{1} << 31;
    large.settings.lights.seed = ~std::uint64_t{0};
    large.settings.lights.radius = 1e30;
    large.settings.lights.intensity = 1e30;
    large.settings.ambient = 1e30f;
    large.settings.samples = 65536;
    large.settings.exposure = -126.0f;
    run(file, {}, {}, [&](ViewState& state) { state = large; });
    EXPECT_EQ(loaded(file), large);
}

TEST(StateFile, TheCommandLineWins) {
    const TemporaryFolder folder;
    const auto file = folder / "view.json";
    run(file, {}, {}, [](ViewState& state) { state = unusual_state(); });
    ViewState given;
    given.settings.lights.count = 7;
    run(file, given, {"--lights"}, [](ViewState& state) {
        EXPECT_EQ(state.settings.lights.count, 7u);
        EXPECT_EQ(state.settings.want.view, ViewKind::slices);
    });
}

TEST(StateFile, TheCommandLineIsNotKept) {
    const TemporaryFolder folder;
    const auto file = folder / "view.json";
    run(file, {}, {}, [](ViewState& state) { state.settings.lights.count = 300; });
    ViewState given;
    given.settings.lights.count = 7;
    given.settings.exposure = 2.0f;
    run(file, given, {"--lights", "--exposure"}, [](ViewState& state) { state.vsync = false; });
    EXPECT_EQ(loaded(file).settings.lights.count, 300u);
    EXPECT_EQ(loaded(file).settings.exposure, 0.0f);
    EXPECT_FALSE(loaded(file).vsync);
    // A value changed in the window is kept, even one of the command line.
    run(file, given, {"--lights"}, [](ViewState& state) { state.settings.lights.count = 8; });
    EXPECT_EQ(loaded(file).settings.lights.count, 8u);
}

TEST(StateFile, ForgottenValuesAreTheDefaults) {
    const TemporaryFolder folder;
    const auto file = folder / "view.json";
    run(file, {}, {}, [](ViewState& state) { state = unusual_state(); });
    StateFile state_file(file);
    ViewState given;
    given.settings.lights.count = 5000;
    const auto is_given = [](const std::string& option) { return option == "--lights"; };
    ViewState reset;
    reset.window_size = state_file.load(given, is_given).window_size;
    state_file.forget();
    state_file.save(reset);
    ViewState expected;
    expected.window_size = unusual_state().window_size;
    EXPECT_EQ(loaded(file), expected);
}

TEST(StateFile, IsWrittenOnlyWhenSomethingChanged) {
    const TemporaryFolder folder;
    const auto file = folder / "view.json";
    run(file, {}, {}, [](ViewState& state) { state = unusual_state(); });
    fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
    const auto before = fs::last_write_time(file);
    run(file, {}, {}, [](ViewState&) {});
    EXPECT_EQ(fs::last_write_time(file), before);
    fs::permissions(folder.path(), fs::perms::owner_all);
}

TEST(StateFile, WhatIsNotOursIsIgnoredAsAWhole) {
    const TemporaryFolder folder;
    const auto file = folder / "view.json";
    for (const char* text :
         {"", "{", "[]", "nonsense", R"({"version": 99})", R"({"version": 2, "lights": "many"})",
          R"({"version": 2, "exposure": 2, "renderer": "raytraced"})",
          R"({"version": 2, "exposure": 2, "lights": -5})",
          R"({"version": 2, "exposure": 2, "lights": 1.5})",
          R"({"version": 2, "exposure": 2, "lights": 3e9})",
          R"({"version": 2, "exposure": 2, "adaptive": 1})",
          R"({"version": 2, "exposure": 2, "grid": "3"})",
          R"({"version": 2, "exposure": 2, "fine-slices": 65})"}) {
        write_text(file, text);
        testing::internal::CaptureStderr();
        EXPECT_EQ(loaded(file), ViewState{}) << text;
        const std::string said = testing::internal::GetCapturedStderr();
        // Each message is printed once a process.
        EXPECT_LE(std::count(said.begin(), said.end(), '\n'), 1) << said;
        EXPECT_EQ(text_of_file(file), text) << "the file is left as it is";
    }
}

TEST(StateFile, NoFileIsNoTrouble) {
    testing::internal::CaptureStderr();
    EXPECT_EQ(loaded("/nowhere/view.json"), ViewState{});
    StateFile("").save({});
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace kilolux
