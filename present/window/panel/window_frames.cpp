// SPDX-License-Identifier: Apache-2.0
#include "present/window/panel/window_frames.h"

#include <epoxy/gl.h>

#include <algorithm>

#include "host/base/error.h"
#include "present/image/image_file.h"
#include "present/window/screen/read_screen.h"
#include "raster/gl_context.h"

namespace kilolux {

WindowFrames::WindowFrames(Screen& screen, std::optional<double> fixed_seconds)
    : screen_(screen), fixed_seconds_(fixed_seconds), gui_(screen) {
    screen_.on_event([this](const InputEvent& event) { events_.post(event); });
}

WindowFrames::~WindowFrames() { screen_.on_event({}); }

void WindowFrames::begin(double seconds, const std::function<void()>& then) {
    clock_.end_frame();
    screen_.wait_events(seconds);
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
    screen_.wake();
}

void WindowFrames::begin_description() {
    gui_.begin(input_, fixed_seconds_);
    ui_.begin_frame();
}

void WindowFrames::paint(bool vsync) {
    if (frames_to_draw_ > 0) --frames_to_draw_;
    screen_.set_vsync(vsync);
    if (screen_.is_minimised()) return gui_.skip();
    draw();
    screen_.swap();
}

void WindowFrames::draw() {
    const auto pixels = screen_.framebuffer();
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, screen_.framebuffer_name());
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
    draw();
    write_image(file, read_screen(screen_));
}

}  // namespace kilolux
