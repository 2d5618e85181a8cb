// SPDX-License-Identifier: Apache-2.0
#include "raster/gl_debug.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "host/base/error.h"

namespace kilolux {
namespace {

// Shader compilers' messages are skipped: link_program() throws them with the info log.
void record(GLenum source, GLenum type, GLuint, GLenum, GLsizei length, const GLchar* text,
            const void* messages) {
    if (type != GL_DEBUG_TYPE_ERROR || source == GL_DEBUG_SOURCE_SHADER_COMPILER) return;
    // The driver hands back, as const, the pointer that record_gl_errors() gave it.
    auto* recorded = static_cast<GlMessages*>(const_cast<void*>(messages));
    recorded->errors.emplace_back(text, static_cast<std::size_t>(length));
}

// The messages of the current context, or null if it records none.
GlMessages* current_messages() {
    void* function = nullptr;
    void* messages = nullptr;
    glGetPointerv(GL_DEBUG_CALLBACK_FUNCTION, &function);
    glGetPointerv(GL_DEBUG_CALLBACK_USER_PARAM, &messages);
    return function == reinterpret_cast<void*>(record) ? static_cast<GlMessages*>(messages)
                                                       : nullptr;
}

std::string error_name(GLenum error) {
    switch (error) {
        case GL_INVALID_ENUM:
            return "GL_INVALID_ENUM";
        case GL_INVALID_VALUE:
            return "GL_INVALID_VALUE";
        case GL_INVALID_OPERATION:
            return "GL_INVALID_OPERATION";
        case GL_INVALID_FRAMEBUFFER_OPERATION:
            return "GL_INVALID_FRAMEBUFFER_OPERATION";
        case GL_OUT_OF_MEMORY:
            return "GL_OUT_OF_MEMORY";
        default:
            return fmt::format("GL error {}", error);
    }
}

}  // namespace

std::unique_ptr<GlMessages> record_gl_errors() {
    auto messages = std::make_unique<GlMessages>();
    glDebugMessageCallback(record, messages.get());
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    return messages;
}

void check_gl_errors(std::string_view where) {
    std::string text;
    for (GLenum error = glGetError(); error != GL_NO_ERROR; error = glGetError()) {
        text += (text.empty() ? "" : ", ") + error_name(error);
        if (error == GL_CONTEXT_LOST) break;
    }
    if (GlMessages* messages = current_messages()) {
        for (const std::string& error : messages->errors) {
            text += (text.empty() ? "" : "; ") + error;
        }
        messages->errors.clear();
    }
    if (!text.empty()) throw Error(std::string(where) + ": OpenGL: " + text);
}

}  // namespace kilolux
