// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/base/source.h"
#include "raster/gl_object.h"

namespace kilolux {

/// One stage of a program: a spliced GLSL source whose first line is its #version.
struct ShaderText {
    GLenum stage = 0;  // GL_VERTEX_SHADER, ...
    SplicedSource source;
};

/// Preprocessor names and their values, put after the #version line.
using Defines = std::vector<std::pair<std::string, std::string>>;

/// Compiles and links. Throws Error that starts with the file's name and holds the driver's log,
/// its file numbers replaced by names.
GlProgram link_program(std::span<const ShaderText> stages);

/// Vertex and fragment shader from embedded files, with the same defines.
GlProgram load_program(std::string_view vertex, std::string_view fragment, const Defines& defines);

}  // namespace kilolux
