// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "present/cli/options.h"
#include "present/window/app/adaptive_scale.h"
#include "present/window/app/camera_rig.h"
#include "present/window/app/cluster_view.h"
#include "present/window/app/picture_buffers.h"
#include "present/window/app/render_worker.h"
#include "present/window/app/view_state.h"
#include "present/window/app/window.h"
#include "present/window/panel/gui.h"
#include "present/window/panel/panel.h"
#include "present/window/script/script.h"

namespace kilolux {

/// What a run of the window is told.
struct SessionOptions {
    SharedOptions shared;  // scene, camera, time
    ViewState state;
    std::uint64_t exit_after = 0;  // pictures; 0: until it is closed
    std::vector<ScriptStep> script;
    std::filesystem::path screenshot;  // written at the end; empty: none
};

/// A rectangle of the framebuffer [pixel], from the upper left.
struct Area {
    int x = 0, y = 0, width = 0, height = 0;
};

/// The window: what a person does changes the state and the camera, the worker renders what they
/// describe, and every frame shows the latest picture with the panel beside it.
class ViewSession {
 public:
    /// Opens nothing: window and context are there, the window's context is current.
    ViewSession(const Scene& scene, SessionOptions options, Window& window, const Window& context);
    ~ViewSession();

    /// Until the window is closed, exit_after pictures are shown, or a signal comes: Interrupted.
    /// Nothing is rendered while it is minimised, unless something waits for the pictures: a script
    /// or exit_after.
    void run();

    const ViewState& state() const { return state_; }

 private:
    using Clock = std::chrono::steady_clock;

    // A frame of the window, in order.
    void wait();
    void take_results();
    void take_picture(Picture picture);
    void obey_input();
    void describe();
    void request_picture();
    void paint();
    void finish_frame();

    // Input.
    void take_event(const InputEvent& event);
    void obey_key(const KeyEvent& key);
    CameraWish camera_wish();
    void steer();
    void obey_wishes(const PanelWishes& wishes);
    void reset_settings();

    // Pictures.
    PictureRequest wanted() const;
    bool is_moving() const;
    bool is_resting() const;
    bool is_settled() const;
    void post_startup_jobs();
    void save_picture(const std::string& extension);
    void save_window(const std::filesystem::path& file);
    std::string command() const;
    void copy(const std::string& text);
    Area picture_area() const;
    float panel_width() const;

    // Drawing.
    void describe_panel(PanelWishes& wishes);
    void describe_overlay();
    void describe_help();
    void describe_failure(PanelWishes& wishes);

    // Clusters.
    ScreenPlace picture_place() const;
    void ask_probe();
    void describe_picture();
    void describe_clusters();
    void take_clusters();
    void paint_boxes() const;
    void show_boxes();

    // The benchmark.
    void start_bench();
    void start_error();

    const Scene& scene_;
    SessionOptions options_;
    Window& window_;
    ViewState state_;
    CameraRig rig_;
    double time_;  // of the lights [s]
    InputState input_;
    Gui gui_;
    Widgets ui_;
    PictureBuffers buffers_;
    PanelFacts facts_;
    AdaptiveScale scale_;
    std::optional<PictureRequest> requested_;  // the last
    std::uint64_t serial_ = 0;
    std::uint64_t shown_ = 0;         // pictures
    std::optional<Picture> picture_;  // on the screen
    Clock::time_point last_frame_ = Clock::now();
    Clock::time_point last_change_;
    double frame_seconds_ = 0.0;
    std::unique_ptr<ScriptPlayer> script_;  // none: a person
    int lively_frames_ = 0;  // to draw without waiting, for what the panel still has to settle
    bool dragging_ = false;  // the mouse, begun on the picture
    std::unique_ptr<BoxPass> boxes_;        // made when first frozen
    std::optional<FrozenClusters> frozen_;  // asked for by state_.frozen
    bool freezing_ = false;                 // asked for, not there yet
    int box_lights_ = -1;                   // that boxes_ were made for
    std::optional<ProbedPixel> probed_;
    bool probing_ = false;                       // asked for, not there yet
    std::array<int, 3> probed_for_{-1, -1, -1};  // pixel, and number of the picture
    std::shared_ptr<BenchProgress> bench_;       // none before the first
    std::shared_ptr<ErrorProgress> error_;
    bool show_help_ = false;
    bool full_screen_ = false;
    std::shared_ptr<struct SessionNews> news_;  // what jobs of the worker found out
    std::unique_ptr<RenderWorker> worker_;      // last: its thread ends first
};

}  // namespace kilolux
