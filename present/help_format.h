// SPDX-License-Identifier: Apache-2.0
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

}  // namespace kilolux
