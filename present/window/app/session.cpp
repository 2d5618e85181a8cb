// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/session.h"

#include <epoxy/gl.h>

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <utility>

#include "host/base/error.h"
#include "host/base/interrupt.h"
#include "present/window/app/worker_results.h"
#include "raster/gl_context.h"

namespace kilolux {
namespace {

constexpr double kFrameSeconds = 1.0 / 60.0;
constexpr double kIdleSeconds = 0.25;  // signals are looked for that often
constexpr double kRestSeconds = 0.25;  // without a change until a picture is made in full
constexpr int kLivelyFrames = 4;
constexpr std::size_t kFewestPixels = 16;  // of a picture's edge
constexpr int kFewestToKeep = 64;          // [pixel] of the window's edges, from run to run

std::string text_of(GLenum name) {
    const GLubyte* text = glGetString(name);
    return text == nullptr ? "" : reinterpret_cast<const char*>(text);
}

std::uint64_t resident_bytes() {
    std::ifstream statm("/proc/self/statm");
    std::uint64_t size = 0, resident = 0;
    statm >> size >> resident;
    return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

bool same_camera(const Camera& a, const Camera& b) {
    return a.position == b.position && a.world_from_view == b.world_from_view &&
           a.y_fov == b.y_fov && a.orthographic == b.orthographic && a.y_extent == b.y_extent &&
           a.z_near == b.z_near && a.z_far == b.z_far;
}

// Whether two requests show the same, at whatever size.
bool same_content(const PictureRequest& a, const PictureRequest& b) {
    RenderSettings resized = a.settings;
    resized.width = b.settings.width;
    resized.height = b.settings.height;
    return resized == b.settings && a.time == b.time && same_camera(a.camera, b.camera);
}

bool same_request(const PictureRequest& a, const PictureRequest& b) {
    return same_content(a, b) && a.settings == b.settings;
}

}  // namespace

ViewSession::ViewSession(const Scene& scene, SessionOptions options, Window& window,
                         const Window& context)
    : scene_(scene),
      options_(std::move(options)),
      window_(window),
      state_(options_.state),
      rig_(choose_camera(options_.shared.camera, scene), bounds(scene)),
      time_(options_.shared.time),
      gui_(window),
      facts_{.scene = scene,
             .triangles = triangle_count(scene),
             .device = {},
             .plan = {},
             .stats = {},
             .history = {},
             .limits = {},
             .opengl = text_of(GL_RENDERER) + ", " + text_of(GL_VERSION),
             .status = "starting",
             .failure = {},
             .message = {}},
      scale_(state_.target_ms),
      news_(std::make_shared<SessionNews>()) {
    window_.on_event([this](const InputEvent& event) { take_event(event); });
    worker_ = std::make_unique<RenderWorker>(scene, wanted().settings, context);
    if (!options_.script.empty()) {
        script_ = std::make_unique<ScriptPlayer>(
            options_.script,
            ScriptStage{window_, ui_, [this] { return is_settled(); },
                        [this](const std::filesystem::path& file) { save_window(file); }});
    }
}

ViewSession::~ViewSession() {
    window_.on_event({});
    if (bench_) bench_->cancelled = true;
    worker_.reset();
}

void ViewSession::run() {
    while (!window_.should_close()) {
        check_interrupt();
        worker_->check_alive();
        wait();
        take_results();
        obey_input();
        describe();
        request_picture();
        if (window_.is_minimised()) {
            gui_.skip();
        } else {
            paint();
        }
        finish_frame();
        if (options_.exit_after > 0 && shown_ >= options_.exit_after) break;
        if (script_ && script_->is_done()) break;
    }
    if (!options_.screenshot.empty()) save_window(options_.screenshot);
    // Saved states with less are not read.
    const auto size = window_.size_to_keep();
    state_.window_size = {std::max(size[0], kFewestToKeep), std::max(size[1], kFewestToKeep)};
}

void ViewSession::wait() {
    const bool steering = camera_wish().any();
    double seconds = kIdleSeconds;
    if (steering || state_.lights_move || is_moving()) seconds = kFrameSeconds;
    if (lively_frames_ > 0) {
        --lively_frames_;
        seconds = kFrameSeconds;
    }
    if (is_resting()) seconds = kIdleSeconds;
    if (script_) seconds = script_->is_settling() ? 0.01 : 0.0;
    window_.wait_events(seconds);
    const Clock::time_point now = Clock::now();
    frame_seconds_ = std::min(std::chrono::duration<double>(now - last_frame_).count(), 0.25);
    last_frame_ = now;
    if (!script_) return;
    frame_seconds_ = ScriptPlayer::kFrameSeconds;
    script_->advance();
}

// The last picture is what the window wants, in full size.
bool ViewSession::is_settled() const {
    return requested_ && picture_ && picture_->request.serial == requested_->serial &&
           !is_moving() && same_request(*requested_, wanted()) && worker_->is_idle() && !probing_ &&
           !freezing_;
}

void ViewSession::take_event(const InputEvent& event) {
    input_.take(event);
    gui_.take(event);
    lively_frames_ = kLivelyFrames;
}

void ViewSession::take_results() {
    while (std::optional<Picture> picture = worker_->take_picture()) {
        take_picture(std::move(*picture));
    }
    while (const std::optional<RenderWorker::Failure> failure = worker_->take_failure()) {
        if (failure->slot) buffers_.release(*failure->slot);
        // A person reads it and goes on; a script cannot.
        if (script_) throw Error(failure->what);
        facts_.failure = failure->what;
        lively_frames_ = kLivelyFrames;
    }
    news_->take(facts_);
    take_clusters();
}

void ViewSession::take_picture(Picture picture) {
    const RenderSettings& drawn = picture.request.settings;
    buffers_.show(picture.request.slot, drawn.width, drawn.height);
    facts_.stats = picture.frame.stats;
    facts_.device = picture.device;
    facts_.plan = picture.plan;
    facts_.device_bytes = picture.device_bytes;
    if (shown_ == 0) post_startup_jobs();
    facts_.width = drawn.width;
    facts_.height = drawn.height;
    const Area area = picture_area();
    facts_.scale = area.width > 0 ? static_cast<double>(drawn.width) / area.width : 1.0;
    facts_.history.add(picture.frame.stats, drawn.width * drawn.height);
    facts_.status.clear();
    facts_.process_bytes = resident_bytes();
    facts_.picture_way = buffers_.is_mapped() ? "persistent pixel buffer, written by the device"
                                              : "upload from host memory";
    scale_.picture_took(picture.frame.stats.frame_ms, facts_.scale);
    if (boxes_ && !picture.frame.aovs.empty()) {
        boxes_->set_depths(picture.frame.aovs.front().values, drawn.width, drawn.height);
    }
    picture_ = std::move(picture);
    ++shown_;
}

bool ViewSession::is_moving() const {
    return std::chrono::duration<double>(Clock::now() - last_change_).count() < kRestSeconds;
}

// Nobody looks at it, and nobody waits for it.
bool ViewSession::is_resting() const {
    return window_.is_minimised() && !script_ && options_.exit_after == 0;
}

float ViewSession::panel_width() const { return state_.show_panel ? gui_.scaled(360.0f) : 0.0f; }

Area ViewSession::picture_area() const {
    const auto size = window_.size();
    const auto pixels = window_.framebuffer();
    const double ratio = size[0] > 0 ? static_cast<double>(pixels[0]) / size[0] : 1.0;
    const int left = static_cast<int>(ratio * static_cast<double>(panel_width()));
    return {left, 0, std::max(pixels[0] - left, 0), pixels[1]};
}

PictureRequest ViewSession::wanted() const {
    PictureRequest out;
    out.settings = state_.settings;
    const double scale = state_.adaptive ? scale_.scale(is_moving()) : state_.fixed_scale;
    const Area area = picture_area();
    const auto edge = [&](int pixels) {
        return std::max(static_cast<int>(scale * pixels), static_cast<int>(kFewestPixels));
    };
    out.settings.width = edge(area.width);
    out.settings.height = edge(area.height);
    if (state_.frozen) out.settings.want.aovs = {"depth"};
    out.camera = rig_.camera();
    out.time = time_;
    return out;
}

void ViewSession::request_picture() {
    if (is_resting()) return;
    if (state_.lights_move) time_ += state_.light_speed * frame_seconds_;
    scale_.set_target(state_.target_ms);
    PictureRequest next = wanted();
    if (requested_ && !same_content(*requested_, next)) {
        last_change_ = Clock::now();
        next = wanted();
    }
    const bool always = state_.continuous || options_.exit_after > 0;
    if (requested_ && same_request(*requested_, next) && !(always && worker_->is_idle())) return;
    const std::size_t pixels =
        display_stride(next.settings.width) * static_cast<std::size_t>(next.settings.height);
    const std::optional<std::size_t> slot = buffers_.acquire(pixels);
    if (!slot) return;
    next.serial = ++serial_;
    next.slot = *slot;
    next.pixels = buffers_.pixels(*slot);
    requested_ = next;
    if (const auto replaced = worker_->request(std::move(next))) buffers_.release(*replaced);
}

void ViewSession::paint() {
    const auto pixels = window_.framebuffer();
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glViewport(0, 0, pixels[0], pixels[1]);
    glClearColor(0.04f, 0.04f, 0.045f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    gui_.draw();
    check_gl_errors("window");
}

void ViewSession::finish_frame() {
    window_.set_vsync(state_.vsync);
    if (!window_.is_minimised()) window_.swap();
    input_.end_frame();
}

}  // namespace kilolux
