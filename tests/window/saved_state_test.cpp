// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/saved_state.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

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
    state.settings.lights.count = 123456;
    state.settings.lights.radius = 0.1;
    state.settings.grid = {20, 11, 8, 32};
    state.lights_move = true;
    state.light_speed = 2.5;
    state.camera_mode = CameraMode::orbit;
    state.adaptive = false;
    state.fixed_scale = 0.5;
    state.vsync = false;
    state.window_size = {640, 480};
    return state;
}

TEST(SavedState, ComesBackAsItWas) {
    const TemporaryFolder folder;
    const auto file = folder / "new" / "folder" / "view.json";
    save_view_state(file, unusual_state());
    EXPECT_EQ(load_view_state(file, ViewState{}, nothing_given), unusual_state());
}

TEST(SavedState, TheCommandLineWins) {
    const TemporaryFolder folder;
    const auto file = folder / "view.json";
    save_view_state(file, unusual_state());
    ViewState given;
    given.settings.lights.count = 7;
    const ViewState out = load_view_state(
        file, given, [](const std::string& option) { return option == "--lights"; });
    EXPECT_EQ(out.settings.lights.count, 7u);
    EXPECT_EQ(out.settings.want.view, ViewKind::slices);
}

TEST(SavedState, WhatIsNotOursIsLeftOutAsAWhole) {
    const TemporaryFolder folder;
    const auto file = folder / "view.json";
    for (const char* text :
         {"", "{", "[]", "nonsense", R"({"version": 99})", R"({"version": 1, "lights": "many"})",
          R"({"version": 1, "exposure": 2, "renderer": "raytraced"})",
          R"({"version": 1, "exposure": 2, "lights": -5})",
          R"({"version": 1, "exposure": 2, "adaptive": 1})",
          R"({"version": 1, "exposure": 2, "slices": "3"})"}) {
        write_text(file, text);
        testing::internal::CaptureStderr();
        EXPECT_EQ(load_view_state(file, ViewState{}, nothing_given), ViewState{}) << text;
        const std::string said = testing::internal::GetCapturedStderr();
        // Each message is said once a process.
        EXPECT_LE(std::count(said.begin(), said.end(), '\n'), 1) << said;
        EXPECT_EQ(text_of_file(file), text) << "the file is left as it is";
    }
}

TEST(SavedState, NoFileIsNoTrouble) {
    testing::internal::CaptureStderr();
    EXPECT_EQ(load_view_state("/nowhere/view.json", ViewState{}, nothing_given), ViewState{});
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace kilolux
