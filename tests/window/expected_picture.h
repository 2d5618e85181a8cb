// SPDX-License-Identifier: Apache-2.0
// The renderer's picture for settings and camera, to compare screenshots with.
#pragma once

#include <functional>

#include "host/render/renderer.h"
#include "host/scene/generated/scenes.h"
#include "present/cli/camera_choice.h"
#include "tests/window/scripted_window.h"

namespace kilolux {

/// The picture of small_window() without its window: scene plain, 150 lights.
class ExpectedPicture {
 public:
    ExpectedPicture() : renderer_(scene_, settings_of({})) {}

    Camera camera() const { return choose_camera({}, scene_); }  // that the window begins with
    Box box() const { return bounds(scene_); }

    ScenePart of(const Camera& camera, const std::function<void(RenderSettings&)>& change = {}) {
        renderer_.change(settings_of(change));
        const Frame frame = renderer_.render(camera, 0.0);
        ScenePart out{kPanel + frame.width, frame.height, {}};
        const std::size_t first = static_cast<std::size_t>(kUnderlay * frame.width);
        for (std::size_t i = 4 * first; i < frame.display.size(); ++i) {
            if (i % 4 < 3) out.values.push_back(static_cast<float>(frame.display[i]) / 255.0f);
        }
        return out;
    }
    ScenePart of(const std::function<void(RenderSettings&)>& change = {}) {
        return of(camera(), change);
    }

 private:
    static RenderSettings settings_of(const std::function<void(RenderSettings&)>& change) {
        RenderSettings settings;
        settings.lights.count = 150;
        settings.width = 700 - kPanel;
        settings.height = 420;
        if (change) change(settings);
        return settings;
    }

    Scene scene_ = make_generated_scene("plain");
    Renderer renderer_;
};

/// The screenshot shows this picture, to rounding of a colour code.
inline void expect_same_picture(const fs::path& screenshot, const ScenePart& expected) {
    const ScenePart seen = scene_part(screenshot);
    ASSERT_EQ(seen.values.size(), expected.values.size()) << screenshot;
    float largest = 0.0f;
    for (std::size_t i = 0; i < seen.values.size(); ++i) {
        largest = std::max(largest, std::abs(seen.values[i] - expected.values[i]));
    }
    EXPECT_LE(largest, 1.1f / 255.0f) << screenshot;
}

}  // namespace kilolux
