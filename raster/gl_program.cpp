// SPDX-License-Identifier: Apache-2.0
#include "raster/gl_program.h"

#include <array>
#include <regex>
#include <sstream>

#include "host/base/error.h"

namespace kilolux {
namespace {

// A log's lines start with "FILE:LINE(COLUMN)" (Mesa) or "FILE(LINE)" (NVIDIA), FILE being the
// number that #line gave.
std::string with_file_names(const std::string& log, const std::vector<std::string>& files) {
    static const std::regex kPlace(R"(^(\d+)[:(](\d+)\)?(.*)$)");
    std::istringstream lines(log);
    std::string out;
    std::string line;
    while (std::getline(lines, line)) {
        std::smatch match;
        if (std::regex_match(line, match, kPlace) && match[1].length() < 6) {
            const std::size_t file = std::stoul(match[1]);
            if (file < files.size()) line = files[file] + ":" + match[2].str() + match[3].str();
        }
        out += (out.empty() ? "" : "\n") + line;
    }
    return out;
}

// The log of a shader or a program, by OpenGL's two functions for either.
template <typename GetInteger, typename GetLog>
std::string info_log(GLuint name, GetInteger get_integer, GetLog get_log) {
    GLint length = 0;
    get_integer(name, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
    GLsizei written = 0;
    get_log(name, static_cast<GLsizei>(log.size()), &written, log.data());
    log.resize(static_cast<std::size_t>(written));
    return log;
}

std::string first_file(const ShaderText& text) {
    return text.source.files.empty() ? "shader" : text.source.files.front();
}

GlShader compile(const ShaderText& text) {
    GlShader shader(glCreateShader(text.stage));
    const GLchar* source = text.source.text.c_str();
    glShaderSource(shader.name(), 1, &source, nullptr);
    glCompileShader(shader.name());
    GLint compiled = GL_FALSE;
    glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &compiled);
    if (compiled == GL_FALSE) {
        const std::string log = info_log(shader.name(), glGetShaderiv, glGetShaderInfoLog);
        throw Error(first_file(text) +
                    ": does not compile: " + with_file_names(log, text.source.files));
    }
    return shader;
}

// An embedded shader with its includes and `defines`.
ShaderText load_shader(GLenum stage, std::string_view path, const Defines& defines) {
    ShaderText text{stage, splice_source(path, true)};
    std::string lines;
    for (const auto& [name, value] : defines) lines += "#define " + name + " " + value + "\n";
    text.source.text.insert(text.source.text.find('\n') + 1, lines);
    return text;
}

}  // namespace

GlProgram link_program(std::span<const ShaderText> stages) {
    GlProgram program(glCreateProgram());
    std::string names;
    std::vector<GlShader> shaders;
    for (const ShaderText& stage : stages) {
        names += (names.empty() ? "" : " + ") + first_file(stage);
        shaders.push_back(compile(stage));
        glAttachShader(program.name(), shaders.back().name());
    }
    glLinkProgram(program.name());
    for (const GlShader& shader : shaders) glDetachShader(program.name(), shader.name());
    GLint linked = GL_FALSE;
    glGetProgramiv(program.name(), GL_LINK_STATUS, &linked);
    if (linked == GL_FALSE) {
        throw Error(names + ": do not link: " +
                    info_log(program.name(), glGetProgramiv, glGetProgramInfoLog));
    }
    return program;
}

GlProgram load_program(std::string_view vertex, std::string_view fragment, const Defines& defines) {
    const std::array<ShaderText, 2> stages = {load_shader(GL_VERTEX_SHADER, vertex, defines),
                                              load_shader(GL_FRAGMENT_SHADER, fragment, defines)};
    return link_program(stages);
}

}  // namespace kilolux
