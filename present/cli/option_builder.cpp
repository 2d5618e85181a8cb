// SPDX-License-Identifier: Apache-2.0
#include "present/cli/option_builder.h"

#include <utility>

#include "host/base/text.h"

namespace kilolux {
namespace {

std::string long_name(const std::string& names) { return names.substr(0, names.find(',')); }

// HelpFormat prints each line after the first as a row below the option.
std::string described(std::string meaning, const Choices& choices) {
    for (std::size_t i = 0; i < choices.meanings.size(); ++i) {
        meaning += "\n" + choices.names[i] + " - " + choices.meanings[i];
    }
    return meaning;
}

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

OptionBuilder& OptionBuilder::value(const OptionText& text, Take take) {
    const std::string name = long_name(text.name);
    const auto taker = [take = std::move(take), name](const std::string& seen) {
        take(name, seen);
    };
    CLI::Option* option = command_.add_option_function<std::string>(text.name, taker, text.meaning);
    option->type_name(text.form)->group(heading_)->default_str(text.standard);
    option->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    return *this;
}

OptionBuilder& OptionBuilder::text(const OptionText& text, std::string& out) {
    return value(text, [&out](const std::string&, const std::string& seen) { out = seen; });
}

OptionBuilder& OptionBuilder::flag(const std::string& name, bool& out, const std::string& meaning) {
    command_.add_flag(name, out, meaning)
        ->group(heading_)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    return *this;
}

OptionBuilder& OptionBuilder::question(const std::string& name, const std::string& meaning) {
    command_.add_flag(name, meaning)->group(heading_);
    return *this;
}

OptionBuilder& OptionBuilder::number_or_auto(const OptionText& text, double& out,
                                             const NumberRange& range) {
    return value(text, [&out, range](const std::string& name, const std::string& seen) {
        out = parse_number_or_auto(name, seen, range);
    });
}

OptionBuilder& OptionBuilder::vector(const OptionText& text, std::optional<glm::dvec3>& out) {
    return value(text, [&out](const std::string& name, const std::string& seen) {
        out = parse_vector(name, seen);
    });
}

OptionBuilder& OptionBuilder::choice(const OptionText& text, std::string& out,
                                     const Choices& choices) {
    return choose(text, choices, [&out, names = choices.names](std::size_t i) { out = names[i]; });
}

OptionBuilder& OptionBuilder::choice_list(OptionText text, std::vector<std::string>& out,
                                          const Choices& choices) {
    text.form = joined(choices.names, "|") + ",...";
    text.meaning = described(text.meaning, choices);
    return value(text,
                 [&out, names = choices.names](const std::string& name, const std::string& seen) {
                     out = parse_name_list(name, seen, names);
                 });
}

OptionBuilder& OptionBuilder::choose(OptionText text, const Choices& choices,
                                     std::function<void(std::size_t)> take) {
    text.form = joined(choices.names, "|");
    text.meaning = described(text.meaning, choices);
    return value(text, [names = choices.names, take = std::move(take)](const std::string& name,
                                                                       const std::string& seen) {
        take(parse_name(name, seen, names));
    });
}

}  // namespace kilolux
