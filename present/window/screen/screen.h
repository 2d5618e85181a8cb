// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "present/window/screen/input.h"

namespace kilolux {

/// The shape of the mouse's pointer.
enum class Cursor { arrow, text, vertical, horizontal, hand };

/// Where a session is seen and its input comes from: a window, or a page in a browser. It has two
/// OpenGL 4.5 core contexts: the session's, current in the thread that made the screen, and the
/// render worker's. Positions and sizes are window coordinates from the upper left.
class Screen {
 public:
    Screen() = default;
    virtual ~Screen() = default;
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;

    /// `take` receives every event, the user's and a script's.
    void on_event(std::function<void(const InputEvent&)> take) { take_ = std::move(take); }
    void post(const InputEvent& event) const {
        if (take_) take_(event);
    }

    /// Makes the worker's context current in this thread, or none.
    virtual void use_worker_context(bool use) const = 0;

    /// Handles events; waits at most `seconds` for one.
    virtual void wait_events(double seconds) = 0;
    /// Ends wait_events(), from any thread.
    virtual void wake() = 0;

    virtual bool should_close() const = 0;
    virtual void close() = 0;
    virtual void hide() = 0;

    virtual std::array<int, 2> size() const = 0;
    virtual std::array<int, 2> framebuffer() const = 0;  // [pixel]; 0,0 while minimised
    /// The OpenGL framebuffer that is drawn to, of framebuffer() pixels; 0: the context's own.
    virtual unsigned framebuffer_name() = 0;
    /// Shows what was drawn.
    virtual void swap() = 0;
    /// Whether a picture that is being made will replace the one that is shown.
    virtual void set_changing(bool changing) = 0;
    /// Whether what was drawn last has not been sent yet: another picture would replace it unseen.
    virtual bool is_behind() const = 0;
    virtual float content_scale() const = 0;  // of fonts: 2 on a screen of twice the usual density
    /// Whether nobody can see it.
    virtual bool is_minimised() const = 0;
    virtual void resize(std::array<int, 2> size) = 0;
    /// Does nothing when vertical sync is set already.
    virtual void set_vsync(bool on) = 0;
    virtual void set_full_screen(bool on) = 0;
    virtual bool is_full_screen() const = 0;
    /// The size for the next run: that outside of full screen, for a screen of usual density.
    virtual std::array<int, 2> size_to_keep() const = 0;
    /// Hides the mouse and lets it move without end.
    virtual void grab_mouse(bool on) = 0;
    virtual void set_cursor(Cursor cursor) = 0;
    virtual void set_clipboard(const std::string& text) = 0;
    virtual std::string clipboard() const = 0;

 private:
    std::function<void(const InputEvent&)> take_;
};

/// Makes a screen of that size and title. Throws Error.
using OpenScreen =
    std::function<std::unique_ptr<Screen>(std::array<int, 2> size, const std::string& title)>;

}  // namespace kilolux
