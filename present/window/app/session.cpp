// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/session.h"

#include <GLFW/glfw3.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <utility>

#include "host/base/error.h"
#include "host/base/interrupt.h"
#include "host/base/log.h"
#include "present/cli/scene_choice.h"
#include "raster/gl_context.h"

namespace kilolux {
namespace {

constexpr double kFrameSeconds = 1.0 / 60.0;
constexpr double kIdleSeconds = 0.25;  // signals are looked for that often
constexpr double kBusySeconds = 0.1;   // while a thread works; what it ends wakes the loop
constexpr double kKeepSeconds = 0.5;   // a change has to last until it is written
constexpr std::chrono::milliseconds kStopPatience(200);
constexpr int kSmallestKept = 64;  // [pixel] of the window's edges, from run to run

std::string gl_text(GLenum name) {
    const GLubyte* text = glGetString(name);
    return text == nullptr ? "" : reinterpret_cast<const char*>(text);
}

}  // namespace

ViewSession::ViewSession(AnimatedScene& scene, SessionOptions options, StateFile& file,
                         Window& window, const Window& context)
    : lit_scene_(scene),
      scene_(scene.scene()),
      options_(std::move(options)),
      file_(file),
      window_(window),
      state_(options_.state),
      kept_(state_),
      lit_by_(state_.rig),
      rig_(choose_camera(options_.shared, scene_), bounds(scene_)),
      time_(options_.shared.time),
      gui_(window),
      facts_{.scene = scene_,
             .has_unranged_lights = std::ranges::any_of(scene_.lights, lacks_range),
             .triangles = triangle_count(scene_),
             .opengl = gl_text(GL_RENDERER) + ", " + gl_text(GL_VERSION)},
      scale_(state_.target_ms) {
    window_.on_event([this](const InputEvent& event) { take_event(event); });
    worker_ = std::make_unique<RenderWorker>(
        scene_, wanted().settings,
        [&context](bool use) { use ? context.make_current() : glfwMakeContextCurrent(nullptr); },
        [this] {
            woken_ = true;
            wake_windows();
        });
    if (!options_.script.empty()) {
        script_ = std::make_unique<ScriptPlayer>(
            options_.script,
            ScriptStage{window_, ui_, [this] { return settled(); },
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
        if (options_.exit_after > 0 && shown_ >= options_.exit_after) break;
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

// How long the loop may sleep while no event comes [s].
double ViewSession::wait_seconds() {
    if (script_) return script_->is_settling() ? 0.01 : 0.0;
    if (is_resting()) return kIdleSeconds;
    const bool steers = camera_motion().any();
    if (steers || state_.lights_move || is_moving() || frames_to_draw_ > 0) return kFrameSeconds;
    return is_busy() ? kBusySeconds : kIdleSeconds;
}

void ViewSession::wait() {
    const double seconds = wait_seconds();
    window_.wait_events(seconds);
    const Clock::time_point now = Clock::now();
    frame_seconds_ = std::min(std::chrono::duration<double>(now - last_frame_).count(), 0.25);
    last_frame_ = now;
    if (script_) {
        frame_seconds_ = ScriptPlayer::kFrameSeconds;
        script_->advance();
    } else {
        keep_state();
    }
    clock_ += frame_seconds_;
    // After a long wait: a key that ended it has been held for one frame at most.
    if (seconds > kFrameSeconds) frame_seconds_ = std::min(frame_seconds_, kFrameSeconds);
    if (woken_.exchange(false)) redraw_soon();
    fade_notice();
}

void ViewSession::notify(const std::string& text) {
    constexpr double kNoticeSeconds = 6.0;
    facts_.notice = text;
    notice_until_ = clock_ + kNoticeSeconds;
}

// The notice fades during its last second.
void ViewSession::fade_notice() {
    if (facts_.notice.empty()) return;
    const double left = notice_until_ - clock_;
    if (left < 1.0) redraw_soon(1);
    facts_.notice_alpha = static_cast<float>(std::clamp(left, 0.0, 1.0));
    if (left <= 0.0) facts_.notice.clear();
}

void ViewSession::remember_size() {
    const auto size = window_.size_to_keep();
    state_.window_size = {std::max(size[0], kSmallestKept), std::max(size[1], kSmallestKept)};
}

// Writes a change that has lasted kKeepSeconds, so that a crash does not lose it.
void ViewSession::keep_state() {
    if (clock_ < next_keep_) return;
    next_keep_ = clock_ + kKeepSeconds;
    remember_size();
    if (state_ != kept_ && state_ == seen_) {
        kept_ = state_;
        try {
            file_.save(state_);
        } catch (const Error& error) {
            warn(error.what());
        }
    }
    seen_ = state_;
}

void ViewSession::take_event(const InputEvent& event) {
    input_.take(event);
    gui_.take(event);
    redraw_soon(4);  // the panel needs some frames until its layout is final
}

void ViewSession::take_results() {
    std::erase_if(pending_, [this](PendingPicture& pending) { return take_picture(pending); });
    take(limits_, [this](const DeviceLimits& limits) { facts_.limits = limits; });
    if (!take(relighting_, [this](Relit relit) { take_lights(std::move(relit)); })) {
        state_.rig = lit_by_;  // the former lights stay
    }
    if (!relighting_.valid()) obey_actions(std::exchange(held_back_, {}));
    take(measuring_, [this](FrameError error) { take_error(std::move(error)); });
    for (auto& saving : saving_) {
        take(saving, [this](const std::string& what) {
            notify(what);
            requested_.reset();  // the renderer's last picture is the window's again
        });
    }
    std::erase_if(saving_, [](const auto& saving) { return !saving.valid(); });
    facts_.measuring = measuring_.valid();
    facts_.error_share = error_share_;
    take_clusters();
}

void ViewSession::fail(const std::string& what) {
    // A script ends with the message; without one the window shows it.
    if (script_) throw Error(what);
    facts_.failure = what;
}

// Minimised, and no script or --exit-after waits for pictures.
bool ViewSession::is_resting() const {
    return window_.is_minimised() && !script_ && options_.exit_after == 0;
}

bool ViewSession::renders_always() const { return state_.continuous || options_.exit_after > 0; }

float ViewSession::panel_width() const { return state_.show_panel ? gui_.scaled(360.0f) : 0.0f; }

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
