// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "host/render/settings.h"
#include "present/window/app/camera_rig.h"

namespace kilolux {

/// Everything that a person sets in the window, and that is kept from one run to the next.
struct ViewState {
    RenderSettings settings;  // width, height and aovs are the window's business
    bool lights_move = false;
    double light_speed = 1.0;  // seconds of the lights' time in one
    CameraMode camera_mode = CameraMode::fly;
    bool adaptive = true;      // fewer pixels while something moves
    double target_ms = 80.0;   // that a picture may take then
    double fixed_scale = 1.0;  // of the edges, unless adaptive
    bool continuous = false;   // render even when nothing changes
    bool vsync = true;
    bool show_panel = true;
    bool show_overlay = true;
    bool frozen = false;  // the clusters of a moment are drawn as boxes; not kept
    int box_lights = 1;   // that a frozen cluster must have to be drawn
    std::uint64_t bench_lights = 16384;
    bool probe = false;  // lists of the pixel under the mouse
    std::array<int, 2> window_size = {1280, 800};
    std::string folder;  // for saved pictures; empty: where the program was started

    bool operator==(const ViewState&) const = default;
};

}  // namespace kilolux
