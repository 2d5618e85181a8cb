// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "present/commands/picture_files.h"
#include "present/video/y4m.h"

namespace kilolux {

/// The command that makes the pictures of these options, by those that change a picture, without
/// the output's name; a picture notes it.
std::string picture_command(const RenderOptions& options);

/// A comment behind the command that changes with the content of its input files; empty where it
/// has none.
std::string inputs_comment(const RenderOptions& options);

/// A picture that may be in a file already.
struct WantedPicture {
    std::filesystem::path file;
    int width = 0;        // [pixel]
    int height = 0;       // [pixel]
    std::string command;  // picture_command()
    std::string time;     // as a note of the file
};

/// A video that may be in a file already.
struct WantedVideo {
    std::filesystem::path file;
    VideoFormat format;
    std::uint64_t frames = 1;
    std::string note;  // picture_command()
};

WantedVideo wanted_video(const RenderOptions& options);

/// Whether the file holds this picture, by its size and its notes. A
/// file that cannot be read counts as none, with a note. Throws Error for another picture.
bool is_made(const WantedPicture& wanted);

/// The same of a video, by its size, its number of frames and its note.
bool is_made(const WantedVideo& wanted);

}  // namespace kilolux
