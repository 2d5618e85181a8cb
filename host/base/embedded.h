// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace kilolux {

struct EmbeddedFile {
    std::string_view path;  // from the root
    std::string_view text;
};

/// The texts that this binary holds: kernels, shaders, the served page, the benchmark's texts; made
/// by host/base/embed.cmake.
std::span<const EmbeddedFile> embedded_files();

}  // namespace kilolux
