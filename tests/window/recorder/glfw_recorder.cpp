// SPDX-License-Identifier: Apache-2.0
// Loaded before GLFW, it writes the program's calls to the file $KILOLUX_GLFW_RECORD, a call a
// line, and passes them on: "interval N", "swap", "wait SECONDS", "poll", "wake". The effect of
// glfwSwapInterval() is not visible otherwise: llvmpipe's GLX has no swap control to read back.
#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>

struct GLFWwindow;

namespace {

void record(const std::string& line) {
    static const int file = [] {
        const char* path = std::getenv("KILOLUX_GLFW_RECORD");
        return path == nullptr ? -1 : open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
    }();
    const std::string text = line + "\n";
    if (write(file, text.data(), text.size()) != static_cast<ssize_t>(text.size())) std::abort();
}

template <typename Function>
Function* next(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

void glfwSwapInterval(int interval) {
    record("interval " + std::to_string(interval));
    next<void(int)>("glfwSwapInterval")(interval);
}

void glfwSwapBuffers(GLFWwindow* window) {
    record("swap");
    next<void(GLFWwindow*)>("glfwSwapBuffers")(window);
}

void glfwWaitEventsTimeout(double seconds) {
    char text[32];
    std::snprintf(text, sizeof text, "wait %.3f", seconds);
    record(text);
    next<void(double)>("glfwWaitEventsTimeout")(seconds);
}

void glfwPollEvents() {
    record("poll");
    next<void()>("glfwPollEvents")();
}

void glfwPostEmptyEvent() {
    record("wake");
    next<void()>("glfwPostEmptyEvent")();
}

}  // extern "C"
