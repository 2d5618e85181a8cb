// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "present/window/app/view_state.h"

namespace kilolux {

/// Where the window keeps its values: $XDG_CONFIG_HOME/kilolux/view.json, else
/// ~/.config/kilolux/view.json; empty when the environment names neither (XDG Base Directory
/// Specification: relative paths do not count).
std::filesystem::path view_state_file();

/// `state` with the values of the file, but those whose option `is_given` says to be on the command
/// line ("--lights"). No file: `state`. One that cannot be read, or holds anything that the window
/// would not write, is left alone as a whole, and a warning says why.
ViewState load_view_state(const std::filesystem::path& file, const ViewState& state,
                          const std::function<bool(const std::string&)>& is_given);

/// Writes the values, whole or not at all; makes the folder. Throws Error with the reason.
void save_view_state(const std::filesystem::path& file, const ViewState& state);

}  // namespace kilolux
