// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace kilolux {

struct EmbeddedFile {
    std::string_view path;  // from the root
    std::string_view text;
};

/// The sources of kernels and shaders and the texts of the benchmark that this binary holds; made
/// by host/base/embed.cmake.
std::span<const EmbeddedFile> embedded_files();

}  // namespace kilolux
