// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "host/render/settings.h"
#include "host/scene/lights/glow/glowing_surfaces.h"
#include "host/scene/lights/light_aim.h"
#include "host/scene/lights/rig.h"
#include "present/window/app/camera_rig.h"

namespace kilolux {

/// Default number of jittered samples a pixel of a picture at rest.
inline constexpr int kRestSamples = 16;

inline RenderSettings window_settings() {
    RenderSettings settings;
    settings.samples = kRestSamples;
    return settings;
}

/// The window's settings. All but the last group are kept from one run to the next.
struct ViewState {
    RenderSettings settings = window_settings();  // width, height and aovs follow from the window
    Rig rig = Rig::automatic;                     // decides the settings' lights and ambient light
    EmissiveLights emissive_lights = EmissiveLights::automatic;
    bool lights_move = false;
    double light_speed = 1.0;  // seconds of the lights' time per second
    CameraMode camera_mode = CameraMode::fly;
    bool adaptive = true;      // fewer pixels while something moves
    double target_ms = 80.0;   // most time of a picture then
    double fixed_scale = 1.0;  // of the picture's edges when not adaptive
    bool continuous = false;   // render even when nothing changes
    bool vsync = true;
    bool show_panel = true;
    bool show_overlay = true;
    bool probe = false;  // show the lists of the pixel under the mouse
    std::array<int, 2> window_size = {1280, 800};

    bool frozen = false;          // draw the clusters of one picture as boxes
    int box_lights = 1;           // least lights of a frozen cluster that is drawn
    bool error_map = false;       // show the measured error in place of the picture
    int light = -1;               // the selected one of the scene's own, by number; -1: none
    glm::vec3 light_color{1.0f};  // its colour, the brightest channel 1: kept while it is dark
    LightAim light_aim;           // where it points: kept where the direction has no azimuth
    bool outlines = false;        // draw those of lights with a size: own and generated ones

    bool operator==(const ViewState&) const = default;
};

}  // namespace kilolux
