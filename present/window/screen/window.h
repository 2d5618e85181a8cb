// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "present/window/screen/input.h"
#include "raster/gl_debug.h"

struct GLFWwindow;

namespace kilolux {

/// The window system. Throws Error when there is no display, and names the command that needs none.
class WindowSystem {
 public:
    WindowSystem();
    ~WindowSystem();
    WindowSystem(const WindowSystem&) = delete;
    WindowSystem& operator=(const WindowSystem&) = delete;
};

/// A window with an OpenGL 4.5 core context.
class Window {
 public:
    /// Not `visible`: only a context. Throws Error that names the packages when the display has no
    /// OpenGL 4.5.
    Window(std::array<int, 2> size, const std::string& title, bool visible);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    void make_current() const;
    static void make_none_current();  // in this thread

    /// `take` receives every event, the user's and a script's.
    void on_event(std::function<void(const InputEvent&)> take) { take_ = std::move(take); }
    void post(const InputEvent& event) const {
        if (take_) take_(event);
    }

    /// Handles events; waits at most `seconds` for one.
    void wait_events(double seconds) const;

    bool should_close() const;
    void close() const;
    void swap() const;
    void show() const;
    void hide() const;

    std::array<int, 2> size() const;         // window coordinates
    std::array<int, 2> framebuffer() const;  // [pixel]; 0,0 while minimised
    float content_scale() const;             // of fonts: 2 on a screen of twice the usual density
    bool is_minimised() const;
    void resize(std::array<int, 2> size) const;
    /// Sets vertical sync of the current context. Does nothing when it is set already.
    void set_vsync(bool on);
    void set_full_screen(bool on);
    bool is_full_screen() const;
    /// The size for the next run's Window(): that of the window outside of full screen, for a
    /// screen of usual density.
    std::array<int, 2> size_to_keep() const;
    /// Hides the mouse and lets it move without end.
    void grab_mouse(bool on) const;
    void set_clipboard(const std::string& text) const;

    GLFWwindow* handle() const { return window_; }

 private:
    void install_callbacks();

    GLFWwindow* window_ = nullptr;
    std::unique_ptr<GlMessages> messages_;
    std::function<void(const InputEvent&)> take_;
    std::array<int, 4> windowed_place_{};  // x, y, width, height before full screen
    std::optional<bool> vsync_;            // as it was set last
};

/// Wakes wait_events() from any thread.
void wake_windows();

}  // namespace kilolux
