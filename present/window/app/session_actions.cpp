// SPDX-License-Identifier: Apache-2.0
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <cstring>

#include "host/base/error.h"
#include "present/cli/frame_summary.h"
#include "present/cli/scene_choice.h"
#include "present/image/image_file.h"
#include "present/window/app/command_text.h"
#include "present/window/app/session.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

// The first of kilolux-001, kilolux-002, ... that does not exist.
fs::path free_file(const std::string& extension) {
    for (int i = 1;; ++i) {
        fs::path file = fmt::format("kilolux-{:03}{}", i, extension);
        if (!fs::exists(file)) return file;
    }
}

}  // namespace

void ViewSession::obey_actions(Actions actions) {
    if (lights_.are_changing()) hold_back(actions);
    if (actions.reset_camera) rig_.set(choose_camera(lights_.options(), scene_));
    if (actions.frame_scene) rig_.frame();
    if (actions.scene_camera) {
        rig_.set(camera_of(scene_.cameras.at(static_cast<std::size_t>(*actions.scene_camera))));
    }
    if (actions.copy_camera) copy(camera_options(rig_, lights_.options(), scene_));
    if (actions.copy_command) copy(command());
    if (actions.measure_error) error_.begin(*worker_, wanted(), [this] { wake(); });
    if (actions.save_png) save_picture(".png");
    if (actions.save_exr) save_picture(".exr");
    if (actions.help) show_help_ = !show_help_;
    if (actions.close_help) show_help_ = false;
    if (actions.dismiss_failure) failure_.clear();
    if (actions.reset_settings) reset_settings();
    if (actions.full_screen) window_.set_full_screen(!window_.is_full_screen());
    if (actions.close) window_.close();
}

// Holds back actions that need the picture's settings, which belong to lights that are not there
// yet.
void ViewSession::hold_back(Actions& actions) {
    for (bool Actions::*action : {&Actions::measure_error, &Actions::save_png, &Actions::save_exr,
                                  &Actions::copy_command}) {
        held_back_.*action |= std::exchange(actions.*action, false);
    }
}

// Restores the program's defaults, without the command line's values; the device is fixed for the
// run.
void ViewSession::reset_settings() {
    ViewState fresh;
    fresh.settings = SharedOptions().settings;
    fresh.settings.samples = kRestSamples;
    fresh.settings.device = state_.settings.device;
    fresh.settings.background = lights_.options().shown_background;
    fresh.settings.reflections = lights_.options().maps;
    fresh.window_size = state_.window_size;
    state_ = std::move(fresh);
    lights_.forget_command_line(state_.settings);
    lights_.replace(*worker_, state_, wanted().settings);
    file_.forget();
}

void ViewSession::copy(const std::string& text) {
    window_.set_clipboard(text);
    notice_.show("copied: " + text, clock_.now());
    redraw_soon();
}

std::string ViewSession::command() const {
    SharedOptions options = lights_.options();
    options.settings = wanted(1.0).settings;
    options.time = time_;
    return render_command(rig_, options, scene_);
}

void ViewSession::save_picture(const std::string& extension) {
    const PictureRequest request = wanted(1.0);
    SharedOptions shared = lights_.options();
    shared.settings = request.settings;
    const auto save = [request, shared, extension](Renderer& renderer) {
        renderer.change(request.settings);
        const Frame frame = renderer.render(request.camera, request.time);
        ImageNotes notes = picture_notes(shared, renderer.device(), frame.stats);
        notes.camera = request.camera;
        const fs::path file = free_file(extension);
        write_image(file, frame, notes);
        return "wrote " + file.string();
    };
    saving_.emplace_back(worker_->ask(save, AtStop::finish));
}

// A screenshot of the whole window.
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
    draw();
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
