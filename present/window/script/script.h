// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "present/window/panel/widgets.h"
#include "present/window/screen/input.h"
#include "present/window/screen/screen.h"

namespace kilolux {

/// One line of a script.
struct ScriptStep {
    std::string place;               // "FILE:LINE", for messages
    std::vector<std::string> words;  // at least one
};

/// Reads a script: one step per line; empty lines and those that begin with '#' are skipped. Throws
/// UsageError for an unknown step or one with the wrong words, Error if the file cannot be read.
/// README.md lists the steps.
std::vector<ScriptStep> read_script(const std::filesystem::path& file);

/// Whether the picture is complete, or will be; `endless` while it keeps changing.
enum class PictureState { complete, pending, endless };

/// The window's functions that a script uses.
struct ScriptStage {
    Screen& screen;
    const Widgets& ui;
    std::function<PictureState()> picture_state;
    std::function<void(const std::filesystem::path&)> screenshot;
};

}  // namespace kilolux
