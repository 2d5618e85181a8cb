// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace kilolux {

/// What the file of a video tells without being decoded.
struct VideoContents {
    int width = 0;   // [pixel]
    int height = 0;  // [pixel]
    std::uint64_t frames = 0;
    bool is_whole = true;  // of .y4m: the file is its header and whole 4:4:4 frames
    std::string header{};  // of .y4m: its first line
    std::string note{};    // of other types: the comment
};

/// Throws Error where reading the video needs the program ffprobe and it is missing.
void check_can_read_video(const std::filesystem::path& file);

/// Reads .y4m itself, and other types by ffprobe. Throws Error where the file holds no video.
VideoContents read_video(const std::filesystem::path& file);

}  // namespace kilolux
