// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kilolux {

/// A render of a picture small enough for any machine.
inline std::vector<std::string> small_render(const std::filesystem::path& output,
                                             std::vector<std::string> more = {}) {
    std::vector<std::string> words = {"render",   "grid", "--resolution", "48,32",
                                      "--lights", "20",   "-o",           output.string()};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

}  // namespace kilolux
