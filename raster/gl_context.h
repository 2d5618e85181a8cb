// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "raster/gl_debug.h"

namespace kilolux {

/// An OpenGL 4.5 core context without window or surface, made with EGL.
class GlContext {
 public:
    /// Makes a context and makes it current in this thread. `platform` (or, when it is empty, the
    /// environment's KILOLUX_EGL) is "surfaceless", "device", "device:N", or empty for the best:
    /// the devices that are hardware, then the surfaceless platform, then the software devices.
    /// Throws Error that says what was tried, how each failed, and which packages to install.
    static GlContext headless(std::string_view platform = {});
    GlContext(GlContext&&) = default;

    /// Throws Error when the driver refuses.
    void make_current() const;
    /// In this thread.
    static void make_none_current();

    const std::string& platform() const { return platform_; }  // "surfaceless", "device:0"
    const std::string& vendor() const { return vendor_; }
    const std::string& renderer() const { return renderer_; }
    const std::string& version() const { return version_; }

 private:
    // Destroys an EGLContext.
    struct Deleter {
        void* display;  // EGLDisplay, shared by the process: never terminated
        void operator()(void* context) const;
    };

    GlContext(void* display, void* context, std::string platform);

    std::string platform_, vendor_, renderer_, version_;
    std::unique_ptr<GlMessages> messages_;  // outlives the context
    std::unique_ptr<void, Deleter> context_;
};

/// The driver's text of that name; empty without one.
std::string gl_string(unsigned name);

/// Whether the current context draws on the CPU (llvmpipe, softpipe, swrast).
bool is_software_renderer();

}  // namespace kilolux
