// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <string>

namespace kilolux {

/// A bash script that completes commands, options, and values that are names or files, made from
/// the program's own tree of options.
std::string bash_completion(const CLI::App& program);

}  // namespace kilolux
