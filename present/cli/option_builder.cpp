// SPDX-License-Identifier: Apache-2.0
#include "present/cli/option_builder.h"

#include <stdexcept>

#include "host/base/error.h"
#include "host/base/text.h"

namespace kilolux {
namespace {

// HelpFormat prints each line after the first as a row below the option.
OptionText described(OptionText text, const Choices& choices) {
    text.form = joined(choices.names, "|");
    for (std::size_t i = 0; i < choices.meanings.size(); ++i) {
        text.meaning += "\n" + choices.names[i] + " - " + choices.meanings[i];
    }
    return text;
}

// What is wrong with a flag's value as in --quiet=VALUE, or nothing.
std::string flag_problem(const std::string& value) {
    try {
        CLI::detail::to_flag_value(value);
        return "";
    } catch (const std::logic_error&) {  // no number, or one out of range
        return "'" + value + "' is not true or false";
    }
}

}  // namespace

void leave_to_help_all(CLI::App& command, const std::vector<std::string>& names) {
    for (const std::string& name : names) {
        CLI::Option* option = command.get_option(name);
        const std::string heading = option->get_group();
        if (!heading.ends_with(kRestSuffix)) option->group(heading + std::string(kRestSuffix));
    }
}

void add_option(CLI::App& command, const Setting& setting) {
    const OptionText& text = setting.text;
    CLI::Option* option =
        setting.kind == SettingKind::flag
            ? command
                  .add_flag_function(
                      text.name,
                      [take = setting.take](std::int64_t count) {
                          take(count > 0 ? "true" : "false");
                      },
                      text.described())
                  ->check(flag_problem)
            : command.add_option_function<std::string>(text.name, setting.take, text.described())
                  ->type_name(text.form)
                  ->default_str(text.default_text.empty() && setting.show ? setting.show()
                                                                          : text.default_text);
    if (text.form.starts_with('[')) option->expected(0, 1);  // a value may be left out
    option->group(setting.heading)->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
}

void refuse_if(bool is_wrong, const std::string& why) {
    if (is_wrong) throw UsageError(why);
}

void add_question(CLI::App& command, const std::string& heading, const std::string& name,
                  const std::string& meaning) {
    command.add_flag(name, meaning)->group(heading);
}

void add_device_question(CLI::App& command) {
    const CLI::Option* device = command.get_option_no_throw("--device");
    if (device == nullptr) return;
    add_question(command, device->get_group(), "--list-devices",
                 "Print the OpenCL devices and leave");
}

OptionBuilder::OptionBuilder(SettingVisitor visitor, std::string heading)
    : visitor_(std::move(visitor)), heading_(std::move(heading)) {}

OptionBuilder::OptionBuilder(CLI::App& command, std::string heading)
    : OptionBuilder([&command](const Setting& setting) { add_option(command, setting); },
                    std::move(heading)) {}

OptionBuilder& OptionBuilder::rest() {
    heading_ += kRestSuffix;
    return *this;
}

void OptionBuilder::hand_over(Setting setting) {
    setting.heading = heading_;
    visitor_(setting);
}

OptionBuilder& OptionBuilder::value(SettingKind kind, const OptionText& text, const Take& take,
                                    Show show) {
    Setting setting{.text = text, .heading = {}, .kind = kind, .show = std::move(show)};
    setting.take = [take, name = setting.option()](const std::string& seen) { take(name, seen); };
    hand_over(std::move(setting));
    return *this;
}

OptionBuilder& OptionBuilder::flag(const std::string& name, bool& out, const std::string& meaning,
                                   Effect effect) {
    hand_over({.text = {name, "", "", meaning, effect},
               .heading = {},
               .kind = SettingKind::flag,
               .take = [&out](const std::string& seen) { out = seen == "true"; },
               .show = [&out]() -> std::string { return out ? "true" : ""; }});
    return *this;
}

OptionBuilder& OptionBuilder::number_or_auto(const OptionText& text, double& out,
                                             const NumberRange& range) {
    return value(
        text, out,
        [range](const std::string& name, const std::string& seen) {
            return parse_number(name, seen, range, true);
        },
        [&out] { return out == 0.0 ? "auto" : text_of(out); });
}

OptionBuilder& OptionBuilder::choice(const OptionText& text, const Choices& choices,
                                     std::function<void(std::size_t)> take, Show show) {
    Setting setting{.text = described(text, choices),
                    .heading = {},
                    .kind = SettingKind::choice,
                    .words = choices.names,
                    .show = std::move(show)};
    setting.take = [names = choices.names, take = std::move(take), name = setting.option()](
                       const std::string& seen) { take(parse_name(name, seen, names)); };
    hand_over(std::move(setting));
    return *this;
}

OptionBuilder& OptionBuilder::choice(const OptionText& text, std::string& out,
                                     const Choices& choices) {
    return choice(
        text, choices, [&out, names = choices.names](std::size_t place) { out = names[place]; },
        [&out] { return out; });
}

OptionBuilder& OptionBuilder::choice_list(const OptionText& text, std::vector<std::string>& out,
                                          const Choices& choices) {
    Setting setting{.text = described(text, choices),
                    .heading = {},
                    .kind = SettingKind::list,
                    .words = choices.names,
                    .show = [&out] { return joined(out, ","); }};
    setting.text.form += ",...";
    setting.take = [&out, names = choices.names, name = setting.option()](const std::string& seen) {
        out = parse_name_list(name, seen, names);
    };
    hand_over(std::move(setting));
    return *this;
}

}  // namespace kilolux
