// SPDX-License-Identifier: Apache-2.0
#include "raster/gl_context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <mutex>
#include <utility>
#include <vector>

#include "host/base/error.h"
#include "host/base/system/memory.h"
#include "host/base/text.h"

namespace kilolux {
namespace {

// One way to a display: the surfaceless platform, or the device platform with one device.
struct Candidate {
    std::string name;
    EGLenum platform = 0;
    void* native = nullptr;
    bool software = false;
};

std::string egl_error() {
    const EGLint error = eglGetError();
    switch (error) {
        case EGL_SUCCESS:
            return "no error given";
        case EGL_NOT_INITIALIZED:
            return "EGL_NOT_INITIALIZED";
        case EGL_BAD_ACCESS:
            return "EGL_BAD_ACCESS";
        case EGL_BAD_ALLOC:
            return "EGL_BAD_ALLOC";
        case EGL_BAD_MATCH:
            return "EGL_BAD_MATCH";
        case EGL_BAD_PARAMETER:
            return "EGL_BAD_PARAMETER";
        case EGL_BAD_CONFIG:
            return "EGL_BAD_CONFIG";
        default:
            return fmt::format("EGL error {}", error);
    }
}

bool has_word(const char* words, std::string_view word) {
    return words != nullptr && std::ranges::count(split(words, ' '), word) > 0;
}

std::vector<Candidate> device_candidates(const char* client_extensions) {
    std::vector<Candidate> out;
    const bool enumerates = has_word(client_extensions, "EGL_EXT_device_enumeration") ||
                            has_word(client_extensions, "EGL_EXT_device_base");
    if (!enumerates || !has_word(client_extensions, "EGL_EXT_platform_device")) return out;
    EGLint count = 0;
    if (!eglQueryDevicesEXT(0, nullptr, &count) || count <= 0) return out;
    std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
    if (!eglQueryDevicesEXT(count, devices.data(), &count)) return out;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
        const char* extensions = eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS);
        out.push_back({fmt::format("device:{}", i), EGL_PLATFORM_DEVICE_EXT, devices[i],
                       has_word(extensions, "EGL_MESA_device_software")});
    }
    return out;
}

// Every way to a display that `wanted` allows, best first.
std::vector<Candidate> candidates(std::string_view wanted) {
    const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    const std::vector<Candidate> devices = device_candidates(extensions);
    std::vector<Candidate> out;
    for (const Candidate& device : devices) {
        if (!device.software) out.push_back(device);
    }
    if (has_word(extensions, "EGL_MESA_platform_surfaceless")) {
        out.push_back({"surfaceless", EGL_PLATFORM_SURFACELESS_MESA, nullptr, false});
    }
    for (const Candidate& device : devices) {
        if (device.software) out.push_back(device);
    }
    std::erase_if(out, [&](const Candidate& c) {
        if (wanted.empty()) return false;
        return c.name != wanted && !(wanted == "device" && c.name.starts_with("device:"));
    });
    return out;
}

// Chooses a config only where the display needs one.
EGLConfig choose_config(EGLDisplay display) {
    if (has_word(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_no_config_context")) {
        return EGL_NO_CONFIG_KHR;
    }
    constexpr std::array<EGLint, 5> kWanted = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT,
                                               EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(display, kWanted.data(), &config, 1, &count) || count < 1) {
        throw Error("no EGL config for OpenGL");
    }
    return config;
}

EGLDisplay open_display(const Candidate& candidate) {
    EGLDisplay display = eglGetPlatformDisplayEXT(candidate.platform, candidate.native, nullptr);
    if (display == EGL_NO_DISPLAY) throw Error("no display: " + egl_error());
    if (!eglInitialize(display, nullptr, nullptr)) {
        throw Error("eglInitialize: " + egl_error());
    }
    if (!has_word(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context")) {
        throw Error("EGL_KHR_surfaceless_context is missing");
    }
    return display;
}

EGLContext create_context(EGLDisplay display) {
    if (!eglBindAPI(EGL_OPENGL_API)) throw Error("eglBindAPI(OpenGL): " + egl_error());
    constexpr std::array<EGLint, 7> kContextAttributes = {EGL_CONTEXT_MAJOR_VERSION,
                                                          4,
                                                          EGL_CONTEXT_MINOR_VERSION,
                                                          5,
                                                          EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                                          EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                                          EGL_NONE};
    EGLContext context = eglCreateContext(display, choose_config(display), EGL_NO_CONTEXT,
                                          kContextAttributes.data());
    if (context == EGL_NO_CONTEXT) throw Error("no OpenGL 4.5 core context: " + egl_error());
    if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
        const std::string error = egl_error();
        eglDestroyContext(display, context);
        throw Error("eglMakeCurrent: " + error);
    }
    return context;
}

bool has_egl() {
    static const bool is_there = ::dlopen("libEGL.so.1", RTLD_LAZY | RTLD_LOCAL) != nullptr;
    return is_there;
}

// Throws where EGL is missing: the loader of OpenGL's functions would end the program.
void require_egl() {
    // Mesa 22 with llvmpipe takes 530 MiB up to its first pictures. With less, LLVM aborts.
    constexpr std::uint64_t kAddressSpace = std::uint64_t{720} << 20;
    static std::once_flag started;  // stays unset where this throws
    std::call_once(started, [] { require_address_space(kAddressSpace, "OpenGL's driver"); });
    if (has_egl()) return;
    throw Error(
        "EGL: libEGL.so.1 cannot be loaded, and so nothing drawn by OpenGL; Debian's "
        "libegl1 provides it (--geometry compute needs none)");
}

}  // namespace

GlContext GlContext::headless(std::string_view platform) {
    require_egl();
    ::setenv("EGL_LOG_LEVEL", "fatal", 0);  // the Error holds the messages
    const char* variable = std::getenv("KILOLUX_EGL");
    const std::string wanted(platform.empty() && variable != nullptr ? variable : platform);
    std::string failures;
    for (const Candidate& candidate : candidates(wanted)) {
        try {
            EGLDisplay display = open_display(candidate);
            return {display, create_context(display), candidate.name};
        } catch (const Error& error) {
            failures += (failures.empty() ? "" : "; ") + candidate.name + ": " + error.what();
        }
    }
    if (failures.empty()) {
        failures = wanted.empty() ? "EGL offers neither surfaceless nor device platform"
                                  : "EGL offers no platform '" + wanted + "'";
    }
    throw Error("EGL: no headless OpenGL 4.5 context (" + failures +
                "); Debian's libegl1 and libgl1-mesa-dri provide one");
}

GlContext::GlContext(void* display, void* context, std::string platform)
    : platform_(std::move(platform)),
      vendor_(gl_string(GL_VENDOR)),
      renderer_(gl_string(GL_RENDERER)),
      version_(gl_string(GL_VERSION)),
      messages_(record_gl_errors()),
      context_(context, Deleter{display}) {}

void GlContext::Deleter::operator()(void* context) const {
    if (eglGetCurrentContext() == context) {
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    eglDestroyContext(display, context);
}

void GlContext::make_current() const {
    EGLDisplay display = context_.get_deleter().display;
    if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context_.get())) {
        throw Error("EGL: " + platform_ + ": eglMakeCurrent: " + egl_error());
    }
}

void GlContext::make_none_current() {
    // The display is the context's; without one there is nothing to do.
    if (eglGetCurrentContext() == EGL_NO_CONTEXT) return;
    eglMakeCurrent(eglGetCurrentDisplay(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

std::string gl_string(GLenum name) {
    const GLubyte* text = glGetString(name);
    return text == nullptr ? "" : reinterpret_cast<const char*>(text);
}

bool is_software_renderer() {
    const std::string renderer = gl_string(GL_RENDERER);
    for (const char* name : {"llvmpipe", "softpipe", "swrast", "Software Rasterizer"}) {
        if (renderer.find(name) != std::string::npos) return true;
    }
    return false;
}

}  // namespace kilolux
