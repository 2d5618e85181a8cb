// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "host/render/settings.h"
#include "host/scene/lights/rig.h"
#include "present/window/app/camera_rig.h"

namespace kilolux {

/// Jittered samples a pixel that a picture at rest gets, unless told otherwise.
inline constexpr int kRestSamples = 16;

inline RenderSettings window_settings() {
    RenderSettings settings;
    settings.samples = kRestSamples;
    return settings;
}

/// What can be set in the window. All but the last group is kept from one run to the next.
struct ViewState {
    RenderSettings settings = window_settings();  // width, height and aovs follow from the window
    Rig rig = Rig::automatic;                     // decides of settings' lights and ambient
    bool lights_move = false;
    double light_speed = 1.0;  // seconds of the lights' time per second
    CameraMode camera_mode = CameraMode::fly;
    bool adaptive = true;      // fewer pixels while something moves
    double target_ms = 80.0;   // that a picture may take then
    double fixed_scale = 1.0;  // of the picture's edges when not adaptive
    bool continuous = false;   // render even when nothing changes
    bool vsync = true;
    bool show_panel = true;
    bool show_overlay = true;
    bool probe = false;  // show the lists of the pixel under the mouse
    std::array<int, 2> window_size = {1280, 800};

    bool frozen = false;     // draw the clusters of one picture as boxes
    int box_lights = 1;      // that a frozen cluster must have to be drawn
    bool error_map = false;  // show the measured error in place of the picture

    bool operator==(const ViewState&) const = default;
};

}  // namespace kilolux
