// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <concepts>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "present/cli/names.h"
#include "present/cli/option_values.h"
#include "present/cli/setting.h"

namespace kilolux {

/// The end of a heading whose options --help leaves to --help-all.
inline constexpr std::string_view kRestSuffix = " (more)";

/// Leaves options of `command` to --help-all: those that it has only because every command takes
/// the same options.
void leave_to_help_all(CLI::App& command, const std::vector<std::string>& names);

/// How a value of a type is written.
template <typename T>
constexpr SettingKind kind_of() {
    if constexpr (requires(T value) { value.has_value(); })
        return kind_of<typename T::value_type>();
    if constexpr (requires { typename T::value_type; } && !std::is_convertible_v<T, std::string>) {
        if constexpr (std::is_same_v<T, std::vector<std::string>>) return SettingKind::list;
        if constexpr (std::is_floating_point_v<typename T::value_type>) return SettingKind::numbers;
        return kind_of<typename T::value_type>();
    }
    if constexpr (std::is_same_v<T, Box>) return SettingKind::numbers;
    if constexpr (std::is_integral_v<T>) return SettingKind::count;
    if constexpr (std::is_floating_point_v<T>) return SettingKind::number;
    return SettingKind::text;
}

/// Makes settings under one heading and hands each to a visitor. Texts are checked when a setting
/// takes them, with the long name and the text seen in the UsageError.
class OptionBuilder {
 public:
    OptionBuilder(SettingVisitor visitor, std::string heading);

    /// Registers them as options of a command: see add_option().
    OptionBuilder(CLI::App& command, std::string heading);

    /// Leaves the options that follow to --help-all.
    OptionBuilder& rest();

    /// Any text that `take` accepts; it gets the long name for its messages, and the text. `show`:
    /// see Setting.
    using Take = std::function<void(const std::string& name, const std::string& text)>;
    using Show = std::function<std::string()>;
    OptionBuilder& value(SettingKind kind, const OptionText& text, const Take& take, Show show);

    /// The value that `parse` makes of the long name and the text.
    template <typename T, typename Parse>
    requires std::invocable<Parse, const std::string&, const std::string&> OptionBuilder& value(
        const OptionText& text, T& out, Parse parse) {
        Show show;
        if constexpr (requires { text_of(out); }) show = [&out] { return text_of(out); };
        return value(text, out, parse, show);
    }
    template <typename T, typename Parse>
    OptionBuilder& value(const OptionText& text, T& out, Parse parse, Show show) {
        const auto take = [&out, parse](const std::string& name, const std::string& seen) {
            out = static_cast<T>(parse(name, seen));
        };
        return value(kind_of<T>(), text, take, std::move(show));
    }

    /// A text, or a path.
    template <typename Text>
    OptionBuilder& text(const OptionText& text, Text& out) {
        return value(text, out, [](const std::string&, const std::string& seen) { return seen; });
    }
    /// A file that is read, or one of `names` in its place.
    template <typename Text>
    OptionBuilder& input_file(const OptionText& text, Text& out,
                              const std::vector<std::string>& names = {}) {
        hand_over({.text = text,
                   .heading = {},
                   .kind = SettingKind::input_file,
                   .words = names,
                   .take = [&out](const std::string& seen) { out = seen; },
                   .show = [&out] { return text_of(out); }});
        return *this;
    }
    OptionBuilder& flag(const std::string& name, bool& out, const std::string& meaning,
                        Effect effect = kNeither);
    template <typename T>
    OptionBuilder& number(const OptionText& text, T& out, const NumberRange& range = {}) {
        return value(text, out, [range](const std::string& name, const std::string& seen) {
            return parse_number(name, seen, range);
        });
    }
    template <typename T>
    OptionBuilder& count(const OptionText& text, T& out, const CountRange& range) {
        return value(text, out, [range](const std::string& name, const std::string& seen) {
            return parse_count(name, seen, range);
        });
    }
    /// 0 is "auto".
    OptionBuilder& number_or_auto(const OptionText& text, double& out, const NumberRange& range);

    /// One of `choices`, whose index `take` gets; `text.form` is made from them.
    OptionBuilder& choice(const OptionText& text, const Choices& choices,
                          std::function<void(std::size_t)> take, Show show);

    /// The index of one of `choices` as a number or enumeration.
    template <typename T>
    OptionBuilder& choice(const OptionText& text, T& out, const Choices& choices) {
        return choice(
            text, choices, [&out](std::size_t place) { out = static_cast<T>(place); },
            [&out, names = choices.names] { return names.at(static_cast<std::size_t>(out)); });
    }
    template <typename Enum>
    requires std::is_enum_v<Enum> OptionBuilder& choice(const OptionText& text, Enum& out) {
        return choice(text, out, choices_of(out));
    }
    OptionBuilder& choice(const OptionText& text, std::string& out, const Choices& choices);

    /// Some of `choices`, separated by commas.
    OptionBuilder& choice_list(const OptionText& text, std::vector<std::string>& out,
                               const Choices& choices);

 private:
    void hand_over(Setting setting);

    SettingVisitor visitor_;
    std::string heading_;
};

/// Registers a setting as an option; of several values given the last one counts.
void add_option(CLI::App& command, const Setting& setting);

/// Registers all settings of `options`.
template <typename Options>
void add_options(CLI::App& command, Options& options) {
    visit_settings(options, [&command](const Setting& setting) { add_option(command, setting); });
}

/// Throws UsageError for `why` where options are wrong together.
void refuse_if(bool is_wrong, const std::string& why);

/// A flag that Program itself handles.
void add_question(CLI::App& command, const std::string& heading, const std::string& name,
                  const std::string& meaning);

/// --list-devices, where the command has --device.
void add_device_question(CLI::App& command);

}  // namespace kilolux
