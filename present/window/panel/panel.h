// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "host/measure/roofline/device_limits.h"
#include "host/measure/roofline/stage_report.h"
#include "host/render/plan/scene_plan.h"
#include "host/scene/scene.h"
#include "present/window/app/own_lights.h"
#include "present/window/app/view_state.h"
#include "present/window/overlay/error_measurement.h"
#include "present/window/panel/stage_history.h"
#include "present/window/panel/widgets.h"

namespace kilolux {

/// Facts about the last picture that the panel shows.
struct PanelFacts {
    const Scene& scene;  // but its lights, which the worker replaces
    const OwnLights& own_lights;
    bool can_glow = false;  // the scene has_glowing_surfaces()
    std::size_t triangles = 0;
    std::string opengl{};  // the window's renderer
    DeviceInfo device{};
    ScenePlan plan{};
    FrameStats stats{};
    RenderSettings displayed{};  // of the last picture
    double scale = 1.0;          // of its edges
    int samples = 1;             // a pixel of the picture, out of displayed.samples
    StageHistory history{};
    std::optional<DeviceLimits> limits{};
    std::uint64_t device_bytes = 0;   // of our OpenCL buffers
    std::uint64_t process_bytes = 0;  // resident
    std::size_t boxes = 0;            // frozen clusters drawn
    const ErrorMeasurement& error;

    /// Notes a picture that is shown at `scale` of its place's edges.
    void note_picture(const PictureRequest& request, const Picture& picture, double scale_now);
};

/// The actions that input asks for in one frame.
struct Actions {
    std::optional<int> scene_camera;
    bool reset_camera = false;
    bool frame_scene = false;
    bool copy_camera = false;
    bool copy_command = false;
    bool save_png = false;
    bool save_exr = false;
    bool full_screen = false;
    bool help = false;  // shows or hides it
    bool close_help = false;
    bool reset_settings = false;
    bool dismiss_failure = false;
    bool measure_error = false;
    bool close = false;
    std::optional<NumberedLight> change_light;  // of the scene's own
    std::optional<std::size_t> reset_light;
    bool reset_lights = false;

    bool operator==(const Actions&) const = default;
};

/// What a section of the panel shows and changes.
struct Panel {
    Widgets& ui;
    ViewState& state;
    Actions& actions;
    const PanelFacts& facts;
};

}  // namespace kilolux
