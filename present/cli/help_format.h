// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/Formatter.hpp>
#include <string>

namespace kilolux {

/// --help as a manual page has it: an option and its value on one line, its meaning wrapped below
/// or beside, the default at its end.
class HelpFormat : public CLI::Formatter {
 public:
    std::string make_help(const CLI::App* app, std::string name,
                          CLI::AppFormatMode mode) const override;
};

/// Two columns: `head` at the left margin, `text` wrapped at the page's width beside it, or below
/// when the head is too long.
std::string help_entry(const std::string& head, const std::string& text);

}  // namespace kilolux
