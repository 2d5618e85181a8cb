// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kilolux {

/// Text of an embedded source file by its path from the root ("kernels/shading/shade.cl",
/// "raster/shaders/scene.vert"). With KILOLUX_SOURCE_DIR set it is read from that folder
/// instead, for development; that is said on stderr. Throws Error when there is no such file.
std::string embedded_text(std::string_view path);

/// Paths of all embedded files that start with `prefix`.
std::vector<std::string> embedded_paths(std::string_view prefix);

/// Path of the kernel file `stem`.cl, in whichever folder of kernels/ it lies: stems are unique.
/// Throws Error when there is no such file.
std::string kernel_path(std::string_view stem);

/// A source with its #include "..." lines replaced by the files' texts, and #line so that a
/// compiler's message names the file and line. Each file appears once. Only where an #if may leave
/// a file out does it appear again at later #includes; its include guard then drops the repeats.
struct SplicedSource {
    std::string text;
    std::vector<std::string> files;  // in order of appearance; GLSL's #line numbers index this
};

/// `glsl`: #line carries the file's index, as GLSL demands, and goes after the #version line.
SplicedSource splice_source(std::string_view path, bool glsl);

}  // namespace kilolux
