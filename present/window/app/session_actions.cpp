// SPDX-License-Identifier: Apache-2.0
#include <epoxy/gl.h>

#include <cstring>

#include "host/base/error.h"
#include "present/cli/frame_summary.h"
#include "present/image/image_file.h"
#include "present/window/app/command_text.h"
#include "present/window/app/session.h"
#include "present/window/app/worker_results.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

// The first of kilolux-001, kilolux-002, ... that is not there.
fs::path free_file(const fs::path& folder, const std::string& extension) {
    for (int i = 1;; ++i) {
        char number[16];
        std::snprintf(number, sizeof number, "%03d", i);
        fs::path file = folder / ("kilolux-" + std::string(number) + extension);
        if (!fs::exists(file)) return file;
    }
}

}  // namespace

void ViewSession::post_startup_jobs() {
    worker_->post([news = news_](Renderer& renderer) {
        const DeviceLimits limits = cached_device_limits(renderer.gpu());
        const std::lock_guard lock(news->mutex);
        news->limits = limits;
    });
}

// Of the picture as it is on the screen.
void ViewSession::start_error() {
    error_ = std::make_shared<ErrorProgress>();
    worker_->post([progress = error_, request = wanted(), &worker = *worker_](Renderer& renderer) {
        const auto tell = [&](double share) {
            progress->share = static_cast<float>(share);
            if (worker.is_stopping()) throw Interrupted();
            wake_windows();
        };
        try {
            const FrameError error =
                measure_frame_error(renderer, request.settings, request.camera, request.time, tell);
            const std::lock_guard lock(progress->mutex);
            progress->result = error;
        } catch (...) {
            progress->running = false;
            throw;
        }
        progress->running = false;
    });
}

void ViewSession::start_bench() {
    BenchRequest request;
    const PictureRequest now = wanted();
    request.settings = now.settings;
    request.settings.want.aovs.clear();
    request.camera = now.camera;
    request.time = now.time;
    request.renderers = {RendererKind::deferred, RendererKind::forward_plus};
    request.most_lights = state_.bench_lights;
    request.csv = free_file(state_.folder, "-bench.csv");
    bench_ = std::make_shared<BenchProgress>();
    worker_->post([news = news_, request, progress = bench_, &scene = scene_](Renderer&) {
        run_bench_job(scene, request, *progress);
        const std::lock_guard lock(news->mutex);
        if (!progress->rows.empty()) news->message = "wrote " + request.csv.string();
    });
}

void ViewSession::obey_wishes(const PanelWishes& wishes) {
    if (wishes.reset_camera) rig_.set(choose_camera(options_.shared.camera, scene_));
    if (wishes.frame_scene) rig_.frame();
    if (wishes.scene_camera) {
        rig_.set(camera_of(scene_.cameras.at(static_cast<std::size_t>(*wishes.scene_camera))));
    }
    if (wishes.copy_camera) {
        copy(camera_options(rig_, options_.shared, scene_));
    }
    if (wishes.copy_command) {
        copy(command());
    }
    if (wishes.measure_error) start_error();
    if (wishes.start_bench) start_bench();
    if (wishes.stop_bench && bench_) bench_->cancelled = true;
    if (wishes.save_png) save_picture(".png");
    if (wishes.save_exr) save_picture(".exr");
    if (wishes.help) show_help_ = !show_help_;
    if (wishes.dismiss_failure) facts_.failure.clear();
    if (wishes.reset_settings) reset_settings();
    if (wishes.full_screen) full_screen_ = !full_screen_;
    window_.set_full_screen(full_screen_);
}

// The program's, whatever the command line said; the device was chosen for the run.
void ViewSession::reset_settings() {
    ViewState fresh;
    fresh.settings = SharedOptions().settings;
    fresh.settings.device = state_.settings.device;
    fresh.window_size = state_.window_size;
    fresh.folder = state_.folder;
    state_ = std::move(fresh);
}

void ViewSession::copy(const std::string& text) {
    window_.set_clipboard(text);
    facts_.message = "copied: " + text;
}

std::string ViewSession::command() const {
    SharedOptions options = options_.shared;
    options.settings = wanted().settings;
    const Area area = picture_area();
    options.settings.width = area.width;
    options.settings.height = area.height;
    options.time = time_;
    return render_command(rig_, options, scene_);
}

// In full size, whatever is on the screen.
void ViewSession::save_picture(const std::string& extension) {
    const fs::path file = free_file(state_.folder, extension);
    PictureRequest request = wanted();
    const Area area = picture_area();
    request.settings.width = std::max(area.width, 16);
    request.settings.height = std::max(area.height, 16);
    SharedOptions shared = options_.shared;
    shared.settings = request.settings;
    worker_->post([news = news_, request, shared, file](Renderer& renderer) {
        renderer.change(request.settings);
        const Frame frame = renderer.render(request.camera, request.time);
        ImageNotes notes = picture_notes(shared, renderer.device(), frame.stats);
        notes.camera = request.camera;
        write_image(file, frame, notes);
        const std::lock_guard lock(news->mutex);
        news->message = "wrote " + file.string();
    });
}

// The window as it is, or of a linear file the picture.
void ViewSession::save_window(const fs::path& file) {
    if (image_meaning(file) == ImageMeaning::linear) {
        throw UsageError("--screenshot: " + file.string() +
                         ": the window is display-referred: PNG, JPEG or TIFF");
    }
    const auto pixels = window_.framebuffer();
    Frame frame;
    frame.width = pixels[0];
    frame.height = pixels[1];
    const std::size_t row = 4 * static_cast<std::size_t>(frame.width);
    std::vector<std::uint8_t> rows(row * static_cast<std::size_t>(frame.height));
    paint();
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    glReadBuffer(GL_BACK);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, frame.width, frame.height, GL_RGBA, GL_UNSIGNED_BYTE, rows.data());
    frame.display.resize(rows.size());
    for (std::size_t y = 0; y < static_cast<std::size_t>(frame.height); ++y) {
        const std::size_t from = (static_cast<std::size_t>(frame.height) - 1 - y) * row;
        std::memcpy(&frame.display[y * row], &rows[from], row);
    }
    for (std::size_t i = 3; i < frame.display.size(); i += 4) frame.display[i] = 255;
    write_image(file, frame);
}

}  // namespace kilolux
