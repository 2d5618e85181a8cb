// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <deque>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "host/scene/animated_scene.h"
#include "present/cli/options.h"
#include "present/window/app/adaptive_scale.h"
#include "present/window/app/camera_rig.h"
#include "present/window/app/cluster_view.h"
#include "present/window/app/picture_buffers.h"
#include "present/window/app/render_worker.h"
#include "present/window/app/state_file.h"
#include "present/window/app/window.h"
#include "present/window/panel/gui.h"
#include "present/window/panel/panel.h"
#include "present/window/script/script.h"

namespace kilolux {

/// What a run of the window is given.
struct SessionOptions {
    SharedOptions asked;   // before light_scene()
    SharedOptions shared;  // scene, camera, time, and what light_scene() settled
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

    /// Ends the worker after files that are being saved. Returns false if it is still busy after a
    /// moment: then only the end of the process ends it.
    bool stop();

 private:
    using Clock = std::chrono::steady_clock;
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
    void fade_notice();
    void remember_size();
    void keep_state();

    // Input.
    void take_event(const InputEvent& event);
    void obey_key(const KeyEvent& key);
    CameraInput camera_motion();
    void steer();
    void obey_actions(Actions actions);
    void hold_back(Actions& actions);
    void reset_settings();

    // Lights.
    struct Relit {
        SharedOptions options;  // settled
        std::string line;       // what light_scene() says
    };
    void relight();
    void take_lights(Relit relit);

    // Pictures.
    struct PendingPicture {
        std::size_t slot = 0;  // of buffers_
        PictureRequest request;
        std::future<Picture> picture;
    };
    PictureRequest wanted() const;
    PictureRequest wanted(double scale) const;  // of the picture's edges
    bool is_moving() const;
    bool is_resting() const;
    bool is_busy() const;
    bool renders_always() const;
    bool refines() const;
    Settled settled() const;
    bool take_picture(PendingPicture& pending);
    void show_picture(const PendingPicture& pending, Picture picture);
    void save_picture(const std::string& extension);
    void save_window(const std::filesystem::path& file);
    std::string command() const;
    void copy(const std::string& text);
    void notify(const std::string& text);
    void fail(const std::string& what);
    template <typename T, typename Take>
    bool take(std::future<T>& future, Take take);
    BoxTarget picture_area() const;
    float panel_width() const;

    // Drawing.
    void describe_panel(Actions& actions);
    void describe_overlay();
    void describe_help();
    void describe_failure(Actions& actions);

    // Clusters and errors.
    ScreenPlace picture_place() const;
    void describe_picture();
    void describe_clusters();
    void ask_probe();
    void ask_clusters();
    void take_clusters();
    void paint_boxes() const;
    void show_boxes();
    void measure_error();
    void take_error(FrameError error);
    bool shows_error() const;

    AnimatedScene& lit_scene_;  // its lights are the worker's
    const Scene& scene_;        // the same
    SessionOptions options_;
    StateFile& file_;
    Window& window_;
    ViewState state_;
    ViewState kept_;  // as last written to file_
    ViewState seen_;  // when writing was considered last
    Rig lit_by_;      // what the scene's lights are for
    CameraRig rig_;
    double time_;  // of the lights [s]
    InputState input_;
    Gui gui_;
    Widgets ui_;
    PictureBuffers buffers_;
    PanelFacts facts_;
    AdaptiveScale scale_;

    std::deque<PendingPicture> pending_;
    std::optional<PictureRequest> requested_;  // the last
    std::optional<PictureRequest> drawn_;      // on the screen
    std::uint64_t shown_ = 0;                  // pictures

    Clock::time_point last_frame_ = Clock::now();
    Clock::time_point last_change_;
    double frame_seconds_ = 0.0;
    double clock_ = 0.0;         // sum of frame_seconds_ [s]
    double notice_until_ = 0.0;  // by clock_
    double next_keep_ = 0.0;     // by clock_
    int frames_to_draw_ = 4;
    std::unique_ptr<ScriptPlayer> script_;  // none: a person
    bool dragging_ = false;                 // the mouse, begun on the picture
    bool show_help_ = false;
    bool full_screen_ = false;

    // Each is valid while its task runs.
    std::future<DeviceLimits> limits_;
    std::future<std::optional<ProbedPixel>> probing_;
    std::future<FrozenClusters> freezing_;
    std::future<FrameError> measuring_;
    std::future<Relit> relighting_;
    Actions held_back_;                            // until the lights are replaced
    std::deque<std::future<std::string>> saving_;  // what was written

    std::unique_ptr<BoxPass> boxes_;        // made when first frozen
    std::optional<FrozenClusters> frozen_;  // while state_.frozen
    int box_lights_ = -1;                   // that boxes_ were made for
    std::optional<ProbedPixel> probed_;
    std::array<int, 3> probed_for_{-1, -1, -1};  // pixel, and number of the picture
    std::optional<PictureRequest> error_of_;     // the picture whose error was measured
    GlTexture error_map_;
    std::atomic<float> error_share_ = 0.0f;  // of the measurement that is done
    std::atomic<bool> woken_ = false;        // by the worker
    std::unique_ptr<RenderWorker> worker_;   // last: its thread ends first
};

/// Takes the result of `future` once it is there. Reports what it throws: then returns false.
template <typename T, typename Take>
bool ViewSession::take(std::future<T>& future, Take take) {
    if (!future.valid() || future.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
        return true;
    }
    std::future<T> ready = std::move(future);
    redraw_soon();
    try {
        take(ready.get());
        return true;
    } catch (const std::exception& error) {
        fail(error.what());
        return false;
    }
}

}  // namespace kilolux
