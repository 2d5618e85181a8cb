// SPDX-License-Identifier: Apache-2.0
#include "present/cli/option_builder.h"

#include "host/base/text.h"

namespace kilolux {
namespace {

std::string long_name(const std::string& names) { return names.substr(0, names.find(',')); }

}  // namespace

void leave_to_help_all(CLI::App& command, const std::vector<std::string>& names) {
    for (const std::string& name : names) {
        CLI::Option* option = command.get_option(name);
        const std::string heading = option->get_group();
        if (!heading.ends_with(kRestSuffix)) option->group(heading + std::string(kRestSuffix));
    }
}

OptionBuilder::OptionBuilder(CLI::App& command, std::string heading)
    : command_(command), heading_(std::move(heading)) {}

OptionBuilder& OptionBuilder::rest() {
    heading_ += kRestSuffix;
    return *this;
}

OptionBuilder& OptionBuilder::value(const OptionText& text, Take take, Show show) {
    const std::string name = long_name(text.name);
    const auto taker = [take = std::move(take), name](const std::string& seen) {
        take(name, seen);
    };
    CLI::Option* option = command_.add_option_function<std::string>(text.name, taker, text.meaning);
    option->type_name(text.form)->group(heading_)->default_str(text.standard);
    option->multi_option_policy(CLI::MultiOptionPolicy::TakeLast)->default_function(show);
    return *this;
}

OptionBuilder& OptionBuilder::flag(const std::string& name, bool& out, const std::string& meaning) {
    command_.add_flag(name, out, meaning)
        ->group(heading_)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast)
        ->default_function([&out]() -> std::string { return out ? "true" : ""; });
    return *this;
}

OptionBuilder& OptionBuilder::question(const std::string& name, const std::string& meaning) {
    command_.add_flag(name, meaning)->group(heading_);
    return *this;
}

OptionBuilder& OptionBuilder::number_or_auto(const OptionText& text, double& out,
                                             const NumberRange& range) {
    return value(text, out, [range](const std::string& name, const std::string& seen) {
        return parse_number_or_auto(name, seen, range);
    });
}

OptionBuilder& OptionBuilder::choice(const OptionText& text, const Choices& choices,
                                     std::function<void(std::size_t)> take, Show show) {
    const auto take_name = [names = choices.names, take = std::move(take)](
                               const std::string& name, const std::string& seen) {
        take(parse_name(name, seen, names));
    };
    return value(described(text, choices), take_name, std::move(show));
}

OptionBuilder& OptionBuilder::choice(const OptionText& text, std::string& out,
                                     const Choices& choices) {
    return value(described(text, choices), out,
                 [names = choices.names](const std::string& name, const std::string& seen) {
                     return names[parse_name(name, seen, names)];
                 });
}

OptionBuilder& OptionBuilder::choice_list(const OptionText& text, std::vector<std::string>& out,
                                          const Choices& choices) {
    OptionText list = described(text, choices);
    list.form += ",...";
    const auto take = [&out, names = choices.names](const std::string& name,
                                                    const std::string& seen) {
        out = parse_name_list(name, seen, names);
    };
    return value(list, take, [&out] { return joined(out, ","); });
}

// HelpFormat prints each line after the first as a row below the option.
OptionText OptionBuilder::described(OptionText text, const Choices& choices) {
    text.form = joined(choices.names, "|");
    for (std::size_t i = 0; i < choices.meanings.size(); ++i) {
        text.meaning += "\n" + choices.names[i] + " - " + choices.meanings[i];
    }
    return text;
}

}  // namespace kilolux
