// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "present/window/screen/screen.h"
#include "raster/gl_debug.h"

struct GLFWcursor;
struct GLFWwindow;

namespace kilolux {

/// The window system. Throws Error when there is no display, and names the commands that need none.
class WindowSystem {
 public:
    WindowSystem();
    ~WindowSystem();
    WindowSystem(const WindowSystem&) = delete;
    WindowSystem& operator=(const WindowSystem&) = delete;
};

/// A window of the desktop, by GLFW.
class Window : public Screen {
 public:
    /// Throws Error that names the packages when the display has no OpenGL 4.5.
    Window(std::shared_ptr<const WindowSystem> system, std::array<int, 2> size,
           const std::string& title);

    void use_worker_context(bool use) const override;
    void wait_events(double seconds) override;
    void wake() override;
    bool should_close() const override;
    void close() override;
    void hide() override;
    std::array<int, 2> size() const override;
    std::array<int, 2> framebuffer() const override;
    unsigned framebuffer_name() override { return 0; }
    void swap() override;
    void set_changing(bool) override {}
    bool is_behind() const override { return false; }
    float content_scale() const override;
    bool is_minimised() const override;
    void resize(std::array<int, 2> size) override;
    void set_vsync(bool on) override;
    void set_full_screen(bool on) override;
    bool is_full_screen() const override;
    std::array<int, 2> size_to_keep() const override;
    void grab_mouse(bool on) override;
    void set_cursor(Cursor cursor) override;
    void set_clipboard(const std::string& text) override;
    std::string clipboard() const override;

 private:
    struct Destroy {
        void operator()(GLFWwindow* window) const;
    };
    // A GLFW window with its context, which records its errors.
    struct Context {
        std::unique_ptr<GlMessages> messages;  // outlives the window
        std::unique_ptr<GLFWwindow, Destroy> window;
    };
    static Context make_context(std::array<int, 2> size, const std::string& title, bool visible);

    void install_callbacks();
    GLFWwindow* handle() const { return shown_.window.get(); }

    std::shared_ptr<const WindowSystem> system_;
    Context worker_;  // never visible
    Context shown_;
    std::vector<GLFWcursor*> cursors_;     // by Cursor; GLFW destroys them
    std::array<int, 4> windowed_place_{};  // x, y, width, height before full screen
    std::optional<bool> vsync_;            // as it was set last
};

}  // namespace kilolux
