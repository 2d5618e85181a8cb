// SPDX-License-Identifier: Apache-2.0
#include "present/window/screen/window.h"

#include <GLFW/glfw3.h>

#include <cmath>
#include <cstdlib>

#include "host/base/error.h"
#include "present/window/screen/display_loss.h"

namespace kilolux {
namespace {

constexpr const char* kWithoutWindow =
    "; kilolux view --serve shows it in a browser, kilolux render makes pictures without a window";

constexpr int kCursorShapes[] = {GLFW_ARROW_CURSOR, GLFW_IBEAM_CURSOR, GLFW_VRESIZE_CURSOR,
                                 GLFW_HRESIZE_CURSOR, GLFW_HAND_CURSOR};

std::string glfw_error() {
    const char* text = nullptr;
    if (glfwGetError(&text) == GLFW_NO_ERROR || text == nullptr) return "no reason given";
    return text;
}

Window& window_of(GLFWwindow* window) {
    return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

void set_hints(bool visible) {
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    if (visible) glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    // Keeps a full-screen window visible when a window on another monitor gets the focus.
    glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE);
}

}  // namespace

WindowSystem::WindowSystem() {
    if (glfwInit() == GLFW_TRUE) {
        end_when_display_is_lost();
        return;
    }
    const char* x11 = std::getenv("DISPLAY");
    const char* wayland = std::getenv("WAYLAND_DISPLAY");
    const bool named = (x11 != nullptr && *x11 != '\0') || (wayland != nullptr && *wayland != '\0');
    throw Error("window: no display (" + glfw_error() +
                (named ? ")" : "; neither DISPLAY nor WAYLAND_DISPLAY is set)") + kWithoutWindow);
}

WindowSystem::~WindowSystem() { glfwTerminate(); }

void Window::Destroy::operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }

Window::Context Window::make_context(std::array<int, 2> size, const std::string& title,
                                     bool visible) {
    set_hints(visible);
    Context out;
    out.window.reset(glfwCreateWindow(size[0], size[1], title.c_str(), nullptr, nullptr));
    if (!out.window) {
        throw Error("window: no OpenGL 4.5 core context (" + glfw_error() +
                    "); Debian's libgl1-mesa-dri and libglx-mesa0 provide one" + kWithoutWindow);
    }
    glfwMakeContextCurrent(out.window.get());
    out.messages = record_gl_errors();
    return out;
}

Window::Window(std::shared_ptr<const WindowSystem> system, std::array<int, 2> size,
               const std::string& title)
    : system_(std::move(system)),
      worker_(make_context({16, 16}, title, false)),
      shown_(make_context(size, title, true)) {
    for (const int shape : kCursorShapes) cursors_.push_back(glfwCreateStandardCursor(shape));
    glfwSetWindowUserPointer(handle(), this);
    install_callbacks();
    glfwShowWindow(handle());
}

void Window::install_callbacks() {
    glfwSetKeyCallback(handle(), [](GLFWwindow* w, int key, int code, int action, int modifiers) {
        window_of(w).post(KeyEvent{key, code, action, modifiers});
    });
    glfwSetCharCallback(handle(),
                        [](GLFWwindow* w, unsigned code) { window_of(w).post(TextEvent{code}); });
    glfwSetMouseButtonCallback(handle(), [](GLFWwindow* w, int button, int action, int modifiers) {
        window_of(w).post(ButtonEvent{button, action, modifiers});
    });
    glfwSetCursorPosCallback(handle(), [](GLFWwindow* w, double x, double y) {
        window_of(w).post(MoveEvent{x, y});
    });
    glfwSetScrollCallback(handle(), [](GLFWwindow* w, double x, double y) {
        window_of(w).post(WheelEvent{x, y});
    });
    glfwSetWindowFocusCallback(handle(), [](GLFWwindow* w, int focused) {
        window_of(w).post(FocusEvent{focused == GLFW_TRUE});
    });
    glfwSetWindowRefreshCallback(handle(), [](GLFWwindow* w) { window_of(w).post(RedrawEvent{}); });
    glfwSetFramebufferSizeCallback(
        handle(), [](GLFWwindow* w, int, int) { window_of(w).post(RedrawEvent{}); });
}

void Window::use_worker_context(bool use) const {
    glfwMakeContextCurrent(use ? worker_.window.get() : nullptr);
}

void Window::wait_events(double seconds) {
    if (seconds > 0.0) {
        glfwWaitEventsTimeout(seconds);
    } else {
        glfwPollEvents();
    }
}

bool Window::should_close() const { return glfwWindowShouldClose(handle()) == GLFW_TRUE; }
void Window::close() { glfwSetWindowShouldClose(handle(), GLFW_TRUE); }
void Window::swap() { glfwSwapBuffers(handle()); }
void Window::hide() { glfwHideWindow(handle()); }

std::array<int, 2> Window::size() const {
    std::array<int, 2> out{};
    glfwGetWindowSize(handle(), &out[0], &out[1]);
    return out;
}

std::array<int, 2> Window::framebuffer() const {
    std::array<int, 2> out{};
    glfwGetFramebufferSize(handle(), &out[0], &out[1]);
    return out;
}

float Window::content_scale() const {
    float x = 1.0f, y = 1.0f;
    glfwGetWindowContentScale(handle(), &x, &y);
    return x > 0.0f ? x : 1.0f;
}

bool Window::is_minimised() const {
    const auto pixels = framebuffer();
    return glfwGetWindowAttrib(handle(), GLFW_ICONIFIED) == GLFW_TRUE || pixels[0] == 0 ||
           pixels[1] == 0;
}

void Window::resize(std::array<int, 2> size) { glfwSetWindowSize(handle(), size[0], size[1]); }

void Window::set_vsync(bool on) {
    if (vsync_ == on) return;
    vsync_ = on;
    glfwSwapInterval(on ? 1 : 0);
}

bool Window::is_full_screen() const { return glfwGetWindowMonitor(handle()) != nullptr; }

void Window::set_full_screen(bool on) {
    if (on == is_full_screen()) return;
    auto& p = windowed_place_;
    if (!on) {
        glfwSetWindowMonitor(handle(), nullptr, p[0], p[1], p[2], p[3], GLFW_DONT_CARE);
        return;
    }
    glfwGetWindowPos(handle(), &p[0], &p[1]);
    glfwGetWindowSize(handle(), &p[2], &p[3]);
    GLFWmonitor* monitor = glfwGetPrimaryMonitor();
    if (monitor == nullptr) return;
    const GLFWvidmode* mode = glfwGetVideoMode(monitor);
    glfwSetWindowMonitor(handle(), monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

std::array<int, 2> Window::size_to_keep() const {
    const auto& p = windowed_place_;
    const auto pixels = is_full_screen() ? std::array{p[2], p[3]} : size();
    const auto usual = [scale = content_scale()](int edge) {
        return static_cast<int>(std::lround(static_cast<float>(edge) / scale));
    };
    return {usual(pixels[0]), usual(pixels[1])};
}

void Window::grab_mouse(bool on) {
    glfwSetInputMode(handle(), GLFW_CURSOR, on ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
}

void Window::set_cursor(Cursor cursor) {
    glfwSetCursor(handle(), cursors_.at(static_cast<std::size_t>(cursor)));
}

void Window::set_clipboard(const std::string& text) {
    glfwSetClipboardString(handle(), text.c_str());
}

std::string Window::clipboard() const {
    const char* text = glfwGetClipboardString(handle());
    return text == nullptr ? "" : text;
}

void Window::wake() { glfwPostEmptyEvent(); }

}  // namespace kilolux
