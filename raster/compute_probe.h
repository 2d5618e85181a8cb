// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "raster/gl_debug.h"
#include "raster/gl_program.h"

namespace kilolux {

/// A compute program of shared headers, then `body`: it computes a shared function in OpenGL.
inline GlProgram compute_program(const std::vector<std::string>& headers, const std::string& body) {
    ShaderText text{GL_COMPUTE_SHADER, {}};
    text.source.files = {"probe"};
    text.source.text = "#version 450 core\n";
    for (const std::string& header : headers) {
        text.source.text += splice_source(header, true).text;
    }
    text.source.text += "#line 1 0\n" + body;
    return link_program(std::span(&text, 1));
}

inline GlBuffer storage_buffer(GLuint binding, const void* bytes, std::size_t size) {
    GlBuffer buffer = make_buffer();
    glNamedBufferStorage(buffer.name(), static_cast<GLsizeiptr>(size), bytes, 0);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.name());
    return buffer;
}

/// Runs a program of local size 64 whose buffers are 0: `in`, 1: `out`, one Out for each In.
template <typename Out, typename In>
std::vector<Out> run_compute(const GlProgram& program, const std::vector<In>& in) {
    std::vector<Out> out(in.size());
    const GlBuffer input = storage_buffer(0, in.data(), in.size() * sizeof(In));
    const GlBuffer output = storage_buffer(1, out.data(), out.size() * sizeof(Out));
    glUseProgram(program.name());
    glDispatchCompute(static_cast<GLuint>((in.size() + 63) / 64), 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(output.name(), 0, static_cast<GLsizeiptr>(out.size() * sizeof(Out)),
                            out.data());
    check_gl_errors("compute probe");
    return out;
}

}  // namespace kilolux
