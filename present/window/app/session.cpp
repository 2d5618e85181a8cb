// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/session.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <utility>

#include "host/base/error.h"
#include "host/base/system/interrupt.h"
#include "present/cli/scene_choice.h"
#include "raster/gl_context.h"

namespace kilolux {
namespace {

constexpr double kIdleSeconds = 0.25;  // signals are checked that often
constexpr double kBusySeconds = 0.1;   // while a thread works; its end wakes the loop
constexpr std::chrono::milliseconds kStopPatience(200);
constexpr int kSmallestKept = 64;  // [pixel] of the window's edges, from run to run

}  // namespace

ViewSession::ViewSession(AnimatedScene& scene, SessionOptions options, StateFile& file,
                         Window& window, const Window& context)
    : scene_(scene.scene()),
      options_(std::move(options)),
      file_(file),
      window_(window),
      state_(options_.state),
      rig_(choose_camera(options_.shared, scene_), bounds(scene_)),
      time_(options_.shared.time),
      gui_(window),
      scale_(state_.target_ms),
      lights_(scene, std::move(options_.asked), options_.shared, state_.rig),
      facts_{.scene = scene_,
             .has_unranged_lights = std::ranges::any_of(scene_.lights, lacks_range),
             .triangles = triangle_count(scene_),
             .opengl = gl_string(GL_RENDERER) + ", " + gl_string(GL_VERSION),
             .error = error_} {
    window_.on_event([this](const InputEvent& event) { events_.post(event); });
    worker_ = std::make_unique<RenderWorker>(
        scene_, wanted().settings,
        [&context](bool use) { use ? context.make_current() : Window::make_none_current(); },
        [this] { wake(); });
    if (!options_.script.empty()) {
        script_ = std::make_unique<ScriptPlayer>(
            options_.script,
            ScriptStage{window_, ui_, [this] { return picture_state(); },
                        [this](const std::filesystem::path& out) { save_window(out); }});
    }
}

ViewSession::~ViewSession() {
    window_.on_event({});
    worker_.reset();
}

void ViewSession::run() {
    while (!window_.should_close()) {
        check_interrupt();
        worker_->check_begun();
        wait();
        take_results();
        obey_input();
        const bool draws = frames_to_draw_ > 0 || script_;
        if (draws) describe();
        request_picture();
        if (draws) paint();
        input_.end_frame();
        if (options_.exit_after > 0 && pictures_.shown() >= options_.exit_after) break;
        if (script_ && script_->is_done()) break;
    }
    if (!options_.screenshot.empty()) save_window(options_.screenshot);
    remember_size();
    file_.save(state_);
}

bool ViewSession::stop() {
    window_.hide();
    return worker_->stop(kStopPatience);
}

void ViewSession::redraw_soon(int frames) { frames_to_draw_ = std::max(frames_to_draw_, frames); }

void ViewSession::wake() {
    woken_ = true;
    wake_windows();
}

// How long the loop may sleep while no event comes [s].
double ViewSession::wait_seconds() {
    if (script_) return script_->is_waiting() ? 0.01 : 0.0;
    if (is_resting()) return kIdleSeconds;
    const bool moves = camera_motion().any() || state_.lights_move || pictures_.is_moving();
    if (moves || frames_to_draw_ > 0 || !events_.empty()) return FrameClock::kUsualSeconds;
    return is_busy() ? kBusySeconds : kIdleSeconds;
}

void ViewSession::wait() {
    const double seconds = wait_seconds();
    clock_.end_frame();
    window_.wait_events(seconds);
    if (script_) script_->advance();
    clock_.begin_frame(seconds,
                       script_ ? std::optional(ScriptPlayer::kFrameSeconds) : std::nullopt);
    for (const InputEvent& event : events_.take(script_ ? 0.0 : clock_.busy_seconds())) {
        input_.take(event);
        gui_.take(event);
        redraw_soon(4);  // the panel needs some frames until its layout is final
    }
    if (!script_) {
        remember_size();
        file_.keep(state_, clock_.now());
    }
    if (woken_.exchange(false)) redraw_soon();
    if (notice_.fade(clock_.now())) redraw_soon(1);
    const std::string waiting = waiting_line();
    if (std::exchange(waiting_, waiting) != waiting) redraw_soon(1);
}

void ViewSession::remember_size() {
    const auto size = window_.size_to_keep();
    state_.window_size = {std::max(size[0], kSmallestKept), std::max(size[1], kSmallestKept)};
}

void ViewSession::take_results() {
    const OnFailure failed = [this](const std::string& what) { fail(what); };
    pictures_.take({[this](const PictureRequest& request, Picture picture) {
                        take_picture(request, std::move(picture));
                    },
                    [this](const PictureRequest& request, double seconds) {
                        const double edge = std::max(area().width, 1);
                        scale_.picture_would_take(1e3 * seconds, request.settings.width / edge);
                    },
                    failed});
    limits_.take([this](const DeviceLimits& limits) { facts_.limits = limits; }, failed);
    lights_.take(state_, failed);
    if (!lights_.are_changing()) obey_actions(std::exchange(held_back_, {}));
    // After these the renderer's last picture is not the window's.
    if (error_.take(failed)) pictures_.forget_request();
    for (auto& saving : saving_) {
        saving.take(
            [this](const std::string& what) {
                notice_.show(what, clock_.now());
                pictures_.forget_request();
            },
            failed);
    }
    std::erase_if(saving_, [](const auto& saving) { return !saving.is_open(); });
    clusters_.take(state_, failed);
}

void ViewSession::fail(const std::string& what) {
    // A script ends with the message; without one the window shows it.
    if (script_) throw Error(what);
    failure_ = what;
    redraw_soon();
}

// Minimised, and no script or --exit-after waits for pictures.
bool ViewSession::is_resting() const {
    return window_.is_minimised() && !script_ && options_.exit_after == 0;
}

// Whether a task or a picture is under way; where pictures never end, they do not count.
bool ViewSession::is_busy() const {
    return limits_.is_open() || clusters_.is_open() || error_.is_open() || lights_.are_changing() ||
           !saving_.empty() || (!renders_always() && pictures_.is_busy());
}

// Whether the last picture is the wanted one, in full size, and no task is left.
PictureState ViewSession::picture_state() const {
    if (state_.lights_move) return PictureState::endless;
    const bool shown = !pictures_.is_moving() && pictures_.has_finished(wanted());
    return shown && !is_busy() ? PictureState::complete : PictureState::pending;
}

void ViewSession::paint() {
    if (frames_to_draw_ > 0) --frames_to_draw_;
    window_.set_vsync(state_.vsync);
    if (window_.is_minimised()) return gui_.skip();
    draw();
    window_.swap();
}

void ViewSession::draw() {
    const auto pixels = window_.framebuffer();
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glViewport(0, 0, pixels[0], pixels[1]);
    glClearColor(0.04f, 0.04f, 0.045f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    gui_.draw();
    check_gl_errors("window");
}

}  // namespace kilolux
