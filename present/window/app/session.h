// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "present/window/app/picture_saving.h"
#include "present/window/app/scene_lights.h"
#include "present/window/app/state_file.h"
#include "present/window/app/steering.h"
#include "present/window/app/window_pictures.h"
#include "present/window/overlay/cluster_overlay.h"
#include "present/window/overlay/error_measurement.h"
#include "present/window/overlay/light_outlines.h"
#include "present/window/overlay/messages.h"
#include "present/window/panel/panel.h"
#include "present/window/panel/window_frames.h"
#include "present/window/script/script.h"
#include "present/window/script/script_player.h"

namespace kilolux {

/// The start of a run of the window.
struct SessionOptions {
    SharedOptions asked;   // before light_scene()
    SharedOptions shared;  // scene, camera, time, and the choices of light_scene()
    ViewState state;
    std::uint64_t exit_after = 0;  // pictures; 0: until it is closed
    std::vector<ScriptStep> script;
    std::filesystem::path screenshot;  // written at the end; empty: none
};

/// What a session begins with that has the options `asked`, which light_scene() made `lit`.
ViewState first_state(const SharedOptions& asked, const SharedOptions& lit);

/// Input changes the state and the camera, the worker renders what they describe, and every frame
/// of the screen shows the latest picture with the panel beside it.
class ViewSession {
 public:
    /// The screen's context is current. Its other one becomes the worker's, and so do the lights of
    /// the scene. Changes of the state go to `file`.
    ViewSession(AnimatedScene& scene, SessionOptions options, StateFile& file, Screen& screen);

    /// Until the window is closed, exit_after pictures are shown, or a signal comes: Interrupted.
    /// Nothing is rendered while it is minimised, unless a script or exit_after waits for pictures.
    void run();

    /// Stops the worker after files that are being saved. Returns false if it is still busy after a
    /// moment: then only the end of the process ends it.
    bool stop();

 private:
    // A frame of the window, in order.
    void begin_frame();
    void take_results();
    void obey_input();
    void describe();
    void request_picture();

    double wait_seconds();
    void remember_size();
    bool is_resting() const;
    bool is_ahead() const;
    bool is_busy() const;
    PictureState picture_state() const;
    void take_picture(const PictureRequest& request, const Picture& picture, double scale);
    void fail(const std::string& what);

    void obey_actions(Actions actions);
    void hold_back(Actions& actions);
    void reset_settings();
    std::string command() const;
    void copy(const std::string& text, const std::string& remark = "");

    std::string waiting_line() const;
    void describe_picture(const ScreenPlace& at);
    void describe_panel(Actions& actions);
    std::vector<std::string> overlay_lines() const;

    const Scene& scene_;
    SessionOptions options_;
    StateFile& file_;
    ViewState state_;
    WindowFrames frames_;
    Steering steering_;
    SceneLights lights_;
    WindowPictures pictures_;
    ClusterOverlay clusters_;
    LightOutlines outlines_;
    ErrorMeasurement error_;
    Awaited<DeviceLimits> limits_;
    PictureSaving saving_;
    Actions held_back_;  // until the lights are replaced
    PanelFacts facts_;
    Messages messages_;
    std::unique_ptr<ScriptPlayer> script_;  // none: input comes from the user
    std::unique_ptr<RenderWorker> worker_;  // last: its thread ends first
};

}  // namespace kilolux
