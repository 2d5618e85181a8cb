// SPDX-License-Identifier: Apache-2.0
// --help, and the completion of options in shells.
#pragma once

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <string>

namespace kilolux {

/// --help in the form of a manual page: an option and its value, its meaning beside or below, the
/// default, and a row for each choice. The mode All adds the headings that end in kRestSuffix.
class HelpFormat : public CLI::Formatter {
 public:
    std::string make_help(const CLI::App* app, std::string name,
                          CLI::AppFormatMode mode) const override;
};

/// A bash script that completes commands, options, and values that are names or files, made from
/// the program's own tree of options.
std::string bash_completion(const CLI::App& program);

}  // namespace kilolux
