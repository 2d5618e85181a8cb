// SPDX-License-Identifier: Apache-2.0
#include "present/window/panel/window_frames.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cstring>

#include "host/base/error.h"
#include "present/image/image_file.h"
#include "raster/gl_context.h"

namespace kilolux {

WindowFrames::WindowFrames(Window& window, std::optional<double> fixed_seconds)
    : window_(window), fixed_seconds_(fixed_seconds), gui_(window) {
    window_.on_event([this](const InputEvent& event) { events_.post(event); });
}

WindowFrames::~WindowFrames() { window_.on_event({}); }

void WindowFrames::begin(double seconds, const std::function<void()>& then) {
    clock_.end_frame();
    window_.wait_events(seconds);
    then();
    clock_.begin_frame(seconds, fixed_seconds_);
    for (const InputEvent& event : events_.take(fixed_seconds_ ? 0.0 : clock_.busy_seconds())) {
        input_.take(event);
        gui_.take(event);
        redraw_soon(4);  // the panel needs some frames until its layout is final
    }
    if (woken_.exchange(false)) redraw_soon();
}

void WindowFrames::redraw_soon(int frames) { frames_to_draw_ = std::max(frames_to_draw_, frames); }

void WindowFrames::wake() {
    woken_ = true;
    wake_windows();
}

void WindowFrames::begin_description() {
    gui_.begin(input_, fixed_seconds_);
    ui_.begin_frame();
}

void WindowFrames::paint(bool vsync) {
    if (frames_to_draw_ > 0) --frames_to_draw_;
    window_.set_vsync(vsync);
    if (window_.is_minimised()) return gui_.skip();
    draw();
    window_.swap();
}

void WindowFrames::draw() {
    const auto pixels = window_.framebuffer();
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glViewport(0, 0, pixels[0], pixels[1]);
    glClearColor(0.04f, 0.04f, 0.045f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    gui_.draw();
    check_gl_errors("window");
}

void WindowFrames::save(const std::filesystem::path& file) {
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
