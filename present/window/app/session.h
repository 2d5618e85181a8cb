// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <deque>
#include <filesystem>
#include <memory>
#include <string>

#include "present/window/app/adaptive_scale.h"
#include "present/window/app/camera_rig.h"
#include "present/window/app/frame_clock.h"
#include "present/window/app/picture_queue.h"
#include "present/window/app/scene_lights.h"
#include "present/window/app/state_file.h"
#include "present/window/overlay/cluster_overlay.h"
#include "present/window/overlay/error_measurement.h"
#include "present/window/overlay/floating.h"
#include "present/window/panel/gui.h"
#include "present/window/panel/panel.h"
#include "present/window/screen/event_queue.h"
#include "present/window/screen/window.h"
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

/// The window: input changes the state and the camera, the worker renders what they describe, and
/// every frame shows the latest picture with the panel beside it.
class ViewSession {
 public:
    /// `window` is current and on the screen; `context` becomes the worker's, and so do the lights
    /// of the scene. Changes of the state go to `file`.
    ViewSession(AnimatedScene& scene, SessionOptions options, StateFile& file, Window& window,
                const Window& context);
    ~ViewSession();

    /// Until the window is closed, exit_after pictures are shown, or a signal comes: Interrupted.
    /// Nothing is rendered while it is minimised, unless a script or exit_after waits for pictures.
    void run();

    /// Stops the worker after files that are being saved. Returns false if it is still busy after a
    /// moment: then only the end of the process ends it.
    bool stop();

 private:
    static constexpr int kSmallestEdge = 16;  // [pixel] of a picture

    // A frame of the window, in order.
    void wait();
    void take_results();
    void obey_input();
    void describe();
    void request_picture();
    void paint();
    void draw();
    double wait_seconds();
    void redraw_soon(int frames = 2);
    void wake();  // from any thread
    void remember_size();

    // Input.
    void obey_key(const KeyEvent& key);
    CameraInput camera_motion();
    void steer();
    void obey_actions(Actions actions);
    void hold_back(Actions& actions);
    void reset_settings();

    // Pictures.
    PictureRequest wanted() const;
    PictureRequest wanted(double scale) const;  // of the picture's edges
    bool is_resting() const;
    bool is_busy() const;
    bool renders_always() const { return state_.continuous || options_.exit_after > 0; }
    bool refines() const;
    PictureState picture_state() const;
    void take_picture(const PictureRequest& request, Picture picture);
    void save_picture(const std::string& extension);
    void save_window(const std::filesystem::path& file);
    std::string command() const;
    void copy(const std::string& text);
    void fail(const std::string& what);

    // The picture's place.
    float panel_width() const { return state_.show_panel ? gui_.scaled(360.0f) : 0.0f; }
    ScreenPlace place() const;  // window coordinates
    BoxTarget area() const;     // framebuffer, from its lower left
    ShownPicture shown_picture();

    // Drawing.
    void describe_picture();
    void describe_panel(Actions& actions);
    std::vector<std::string> overlay_lines() const;
    std::string waiting_line() const;

    const Scene& scene_;
    SessionOptions options_;
    StateFile& file_;
    Window& window_;
    ViewState state_;
    CameraRig rig_;
    double time_;  // of the lights [s]
    FrameClock clock_;
    EventQueue events_;
    InputState input_;
    Gui gui_;
    Widgets ui_;
    AdaptiveScale scale_;

    PictureQueue pictures_;
    SceneLights lights_;
    ClusterOverlay clusters_;
    ErrorMeasurement error_;
    Awaited<DeviceLimits> limits_;
    std::deque<Awaited<std::string>> saving_;  // results of saved files
    Actions held_back_;                        // until the lights are replaced

    PanelFacts facts_;
    Notice notice_;
    std::string failure_;  // the last one; empty: none
    std::string waiting_;  // waiting_line(), as shown
    int frames_to_draw_ = 4;
    bool dragging_ = false;  // the mouse, begun on the picture
    bool show_help_ = false;
    std::unique_ptr<ScriptPlayer> script_;  // none: input comes from the user

    std::atomic<bool> woken_ = false;       // by the worker
    std::unique_ptr<RenderWorker> worker_;  // last: its thread ends first
};

}  // namespace kilolux
