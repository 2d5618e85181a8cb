// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "present/cli/option_values.h"

namespace kilolux {

/// How an option presents itself in --help.
struct OptionText {
    std::string name;  // "--lights", or "--output,-o"
    std::string form;  // of the value: "N"; words in lower case between '|' are names to complete
    std::string standard;  // default as text; empty: the meaning says what happens
    std::string meaning;
};

/// Registers options of a command under one heading. Values are checked while the command line is
/// parsed, with the long name and the text seen in the UsageError; the last one given counts.
class Registrar {
 public:
    Registrar(CLI::App& command, std::string heading);

    /// Any text that `take` accepts; it gets the long name for its messages, and the text.
    using Take = std::function<void(const std::string& name, const std::string& text)>;
    Registrar& value(const OptionText& text, Take take);

    Registrar& text(const OptionText& text, std::string& out);
    Registrar& flag(const std::string& name, bool& out, const std::string& meaning);
    /// A flag that Program itself obeys.
    Registrar& question(const std::string& name, const std::string& meaning);
    Registrar& number(const OptionText& text, double& out, const NumberRange& range = {});
    Registrar& number(const OptionText& text, float& out, const NumberRange& range = {});
    Registrar& number_or_auto(const OptionText& text, double& out, const NumberRange& range);
    Registrar& count(const OptionText& text, std::uint64_t& out, const CountRange& range);
    Registrar& count(const OptionText& text, int& out, const CountRange& range);
    Registrar& vector(const OptionText& text, std::optional<glm::dvec3>& out);

    /// One of `names`, which stand in the order of the enumeration; `text.form` is made of them.
    template <typename Enum>
    Registrar& choice(const OptionText& text, Enum& out, const std::vector<std::string>& names) {
        return place(text, names, [&out](std::size_t i) { out = static_cast<Enum>(i); });
    }
    Registrar& choice(OptionText text, std::string& out, const std::vector<std::string>& names);

 private:
    Registrar& place(OptionText text, const std::vector<std::string>& names,
                     std::function<void(std::size_t)> take);

    CLI::App& command_;
    std::string heading_;
};

}  // namespace kilolux
