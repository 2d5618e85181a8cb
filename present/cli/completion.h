// SPDX-License-Identifier: Apache-2.0
// Completion scripts for shells, made from the program's own tree of options.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace kilolux {

/// "bash", "zsh", "fish".
std::vector<std::string> completion_shells();

/// A script that completes commands, options, and the values that are names or files. Throws
/// UsageError for an unknown shell.
std::string completion_script(const CLI::App& program, const std::string& shell);

}  // namespace kilolux
