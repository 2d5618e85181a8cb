// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "present/cli/options.h"

namespace kilolux {

/// The command that makes the pictures of these options, without names of files; a picture notes
/// it.
std::string picture_command(const SharedOptions& shared, const OutputOptions& output);

/// A picture that may be in a file already.
struct WantedPicture {
    std::filesystem::path file;
    int width = 0;        // [pixel]
    int height = 0;       // [pixel]
    std::string command;  // picture_command()
    std::string time;     // as a note of the file
};

/// Whether the file holds this picture, by its size and, where its format keeps them, its notes. A
/// file that cannot be read counts as none, with a note. Throws Error for another picture.
bool is_made(const WantedPicture& wanted);

}  // namespace kilolux
