// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "present/cli/names.h"
#include "present/cli/option_values.h"

namespace kilolux {

/// How an option presents itself in --help.
struct OptionText {
    std::string name;  // "--lights", or "--output,-o"
    std::string form;  // of the value: "N"; words in lower case between '|' are names to complete
    std::string standard;  // default as text; empty: the meaning says what happens
    std::string meaning;
};

/// The end of a heading whose options --help leaves to --help-all.
inline constexpr std::string_view kRestSuffix = " (more)";

/// Leaves options of `command` to --help-all: those it takes so that every command takes the same
/// options, but has little use for.
void leave_to_help_all(CLI::App& command, const std::vector<std::string>& names);

/// Registers options of a command under one heading. Values are checked while the command line is
/// parsed, with the long name and the text seen in the UsageError; the last one given counts.
class OptionBuilder {
 public:
    OptionBuilder(CLI::App& command, std::string heading);

    /// Leaves the options that follow to --help-all.
    OptionBuilder& rest();

    /// Any text that `take` accepts; it gets the long name for its messages, and the text.
    using Take = std::function<void(const std::string& name, const std::string& text)>;
    OptionBuilder& value(const OptionText& text, Take take);

    OptionBuilder& text(const OptionText& text, std::string& out);
    OptionBuilder& flag(const std::string& name, bool& out, const std::string& meaning);
    /// A flag that Program itself obeys.
    OptionBuilder& question(const std::string& name, const std::string& meaning);
    template <typename T>
    OptionBuilder& number(const OptionText& text, T& out, const NumberRange& range = {}) {
        return value(text, [&out, range](const std::string& name, const std::string& seen) {
            out = static_cast<T>(parse_number(name, seen, range));
        });
    }
    template <typename T>
    OptionBuilder& count(const OptionText& text, T& out, const CountRange& range) {
        return value(text, [&out, range](const std::string& name, const std::string& seen) {
            out = static_cast<T>(parse_count(name, seen, range));
        });
    }
    OptionBuilder& number_or_auto(const OptionText& text, double& out, const NumberRange& range);
    OptionBuilder& vector(const OptionText& text, std::optional<glm::dvec3>& out);

    /// One of `choices`, which stand in the order of the enumeration; `text.form` is made of them.
    template <typename Enum>
    OptionBuilder& choice(const OptionText& text, Enum& out, const Choices& choices) {
        return choose(text, choices, [&out](std::size_t i) { out = static_cast<Enum>(i); });
    }
    OptionBuilder& choice(const OptionText& text, std::string& out, const Choices& choices);

    /// Some of `choices`, separated by commas.
    OptionBuilder& choice_list(OptionText text, std::vector<std::string>& out,
                               const Choices& choices);

 private:
    OptionBuilder& choose(OptionText text, const Choices& choices,
                          std::function<void(std::size_t)> take);

    CLI::App& command_;
    std::string heading_;
};

}  // namespace kilolux
