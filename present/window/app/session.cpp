// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/session.h"

#include <GLFW/glfw3.h>
#include <epoxy/gl.h>

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <utility>

#include "host/base/error.h"
#include "host/base/interrupt.h"
#include "host/base/log.h"
#include "raster/gl_context.h"

namespace kilolux {
namespace {

constexpr double kFrameSeconds = 1.0 / 60.0;
constexpr double kIdleSeconds = 0.25;  // signals are looked for that often
constexpr double kRestSeconds = 0.25;  // without a change until a picture is made in full
constexpr double kKeepSeconds = 0.5;   // a change has to last until it is written
constexpr std::chrono::milliseconds kStopPatience(200);
constexpr int kSmallestKept = 64;  // [pixel] of the window's edges, from run to run

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

template <typename T>
bool is_ready(const std::future<T>& future) {
    return future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

ViewSession::ViewSession(const Scene& scene, SessionOptions options, StateFile& file,
                         Window& window, const Window& context)
    : scene_(scene),
      options_(std::move(options)),
      file_(file),
      window_(window),
      state_(options_.state),
      kept_(state_),
      rig_(choose_camera(options_.shared.camera, scene), bounds(scene)),
      time_(options_.shared.time),
      gui_(window),
      facts_{.scene = scene,
             .triangles = triangle_count(scene),
             .opengl = text_of(GL_RENDERER) + ", " + text_of(GL_VERSION)},
      scale_(state_.target_ms) {
    window_.on_event([this](const InputEvent& event) { take_event(event); });
    worker_ = std::make_unique<RenderWorker>(
        scene, wanted().settings,
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

// How long nothing has to be done unless something happens.
double ViewSession::wait_seconds() {
    if (script_) return script_->is_settling() ? 0.01 : 0.0;
    if (is_resting()) return kIdleSeconds;
    const bool steers = camera_motion().any();
    if (steers || state_.lights_move || is_moving() || frames_to_draw_ > 0) return kFrameSeconds;
    return kIdleSeconds;
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
    // A key that has just been pressed has not moved the camera while nothing happened.
    if (seconds == kIdleSeconds) frame_seconds_ = std::min(frame_seconds_, kFrameSeconds);
    if (woken_.exchange(false)) redraw_soon();
    fade_notice();
}

void ViewSession::notify(const std::string& text) {
    constexpr double kNoticeSeconds = 6.0;
    facts_.notice = text;
    notice_until_ = clock_ + kNoticeSeconds;
}

// In its last second.
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

// Changes that last are written: neither a lost display nor a crash loses them.
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

// Whether the last picture is what the window wants, in full size, and no task is left.
Settled ViewSession::settled() const {
    if (state_.lights_move) return Settled::never;
    const bool busy = probing_.valid() || freezing_.valid() || measuring_.valid() ||
                      !saving_.empty() || (!renders_always() && !pending_.empty());
    const bool shown = drawn_ && !is_moving() && same_request(*drawn_, wanted());
    return shown && !busy && frames_to_draw_ == 0 ? Settled::yes : Settled::not_yet;
}

void ViewSession::take_event(const InputEvent& event) {
    input_.take(event);
    gui_.take(event);
    redraw_soon(4);  // the panel needs some frames until its layout is final
}

void ViewSession::take_results() {
    std::erase_if(pending_, [this](PendingPicture& pending) { return take_picture(pending); });
    take(limits_, [this](const DeviceLimits& limits) { facts_.limits = limits; });
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
    // A person reads it and goes on; a script cannot.
    if (script_) throw Error(what);
    facts_.failure = what;
}

// False: it is still being made.
bool ViewSession::take_picture(PendingPicture& pending) {
    if (!is_ready(pending.picture)) return false;
    redraw_soon();
    try {
        Picture picture = pending.picture.get();
        show_picture(pending, std::move(picture));
    } catch (const std::future_error&) {
        buffers_.release(pending.slot);  // a later request replaced it
    } catch (const std::exception& error) {
        buffers_.release(pending.slot);
        fail(error.what());
    }
    return true;
}

void ViewSession::show_picture(const PendingPicture& pending, Picture picture) {
    const RenderSettings& drawn = pending.request.settings;
    buffers_.show(pending.slot, drawn.width, drawn.height);
    if (shown_ == 0) {
        limits_ =
            worker_->ask([](Renderer& renderer) { return cached_device_limits(renderer.gpu()); });
    }
    const Area area = picture_area();
    facts_.scale = area.width > 0 ? static_cast<double>(drawn.width) / area.width : 1.0;
    facts_.width = drawn.width;
    facts_.height = drawn.height;
    facts_.stats = picture.frame.stats;
    facts_.device = picture.device;
    facts_.plan = picture.plan;
    facts_.device_bytes = picture.device_bytes;
    facts_.process_bytes = resident_bytes();
    facts_.picture_way = buffers_.is_mapped() ? "persistent pixel buffer, written by the device"
                                              : "upload from host memory";
    facts_.history.add(picture.frame.stats, drawn.width * drawn.height);
    scale_.picture_took(picture.frame.stats.frame_ms, facts_.scale);
    if (boxes_ && !picture.frame.aovs.empty()) {
        boxes_->set_depths(picture.frame.aovs.front().values, drawn.width, drawn.height);
    }
    drawn_ = pending.request;
    ++shown_;
}

bool ViewSession::is_moving() const {
    return std::chrono::duration<double>(Clock::now() - last_change_).count() < kRestSeconds;
}

// Nobody looks at it, and nobody waits for it.
bool ViewSession::is_resting() const {
    return window_.is_minimised() && !script_ && options_.exit_after == 0;
}

// The map belongs to the picture that was measured.
bool ViewSession::shows_error() const {
    return state_.error_map && error_map_ && error_of_ && same_content(*error_of_, wanted());
}

bool ViewSession::renders_always() const { return state_.continuous || options_.exit_after > 0; }

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
    out.settings.width = std::max(static_cast<int>(scale * area.width), kSmallestEdge);
    out.settings.height = std::max(static_cast<int>(scale * area.height), kSmallestEdge);
    if (state_.frozen) out.settings.aovs = {"depth"};
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
    const bool again = renders_always() && pending_.empty();
    if (requested_ && same_request(*requested_, next) && !again) return;
    const std::size_t pixels =
        display_stride(next.settings.width) * static_cast<std::size_t>(next.settings.height);
    const std::optional<std::size_t> slot = buffers_.acquire(pixels);
    if (!slot) return;
    next.pixels = buffers_.pixels(*slot);
    requested_ = next;
    pending_.push_back({*slot, next, worker_->render(next)});
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
