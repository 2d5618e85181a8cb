// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <filesystem>

namespace kilolux {

/// Gives `command` the options of a file that the command line did not give.
///
/// TOML lines `lights = 1000`, `resolution = [640, 360]`, `quiet = true`, or a JSON object of the
/// same names (a file that begins with '{'). Names are the long options without dashes, and
/// `scene`. Throws Error if the file cannot be read, UsageError for an unknown name or a value out
/// of range.
void apply_config_file(CLI::App& command, const std::filesystem::path& file);

}  // namespace kilolux
