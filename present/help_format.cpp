// SPDX-License-Identifier: Apache-2.0
#include "present/help_format.h"

#include <sstream>
#include <vector>

namespace kilolux {
namespace {

constexpr std::size_t kPageWidth = 80;
constexpr std::size_t kTextColumn = 30;

std::vector<std::string> wrapped(const std::string& text, std::size_t width) {
    std::istringstream words(text);
    std::vector<std::string> lines(1);
    for (std::string word; words >> word;) {
        std::string& line = lines.back();
        if (!line.empty() && line.size() + 1 + word.size() > width) {
            lines.push_back(word);
            continue;
        }
        line += (line.empty() ? "" : " ") + word;
    }
    return lines;
}

// "--output, -o FILE": long names first, as the rest of the program speaks of them.
std::string option_head(const CLI::Option& option) {
    std::string names;
    for (const std::string& name : option.get_lnames()) {
        names += (names.empty() ? "--" : ", --") + name;
    }
    for (const std::string& name : option.get_snames()) {
        names += (names.empty() ? "-" : ", -") + name;
    }
    if (option.get_items_expected_max() == 0) return names;
    return names + " " + option.get_type_name();
}

}  // namespace

std::string help_entry(const std::string& head, const std::string& text) {
    std::string out = "  " + head;
    const std::string indent(kTextColumn, ' ');
    if (out.size() + 2 > kTextColumn) {
        out += "\n" + indent;
    } else {
        out.resize(kTextColumn, ' ');
    }
    bool first = true;
    for (const std::string& line : wrapped(text, kPageWidth - kTextColumn)) {
        out += (first ? "" : indent) + line + "\n";
        first = false;
    }
    return out;
}

std::string HelpFormat::make_option(const CLI::Option* option, bool is_positional) const {
    std::string text = option->get_description();
    if (!option->get_default_str().empty()) text += " [default: " + option->get_default_str() + "]";
    return help_entry(is_positional ? option->get_name(true) : option_head(*option), text);
}

std::string HelpFormat::make_subcommand(const CLI::App* command) const {
    return help_entry(command->get_name(), command->get_description());
}

std::string HelpFormat::make_positionals(const CLI::App* app) const {
    std::string out;
    for (const CLI::Option* option : app->get_options()) {
        if (option->get_positional()) out += make_option(option, true);
    }
    return out.empty() ? out : "\n" + out;
}

std::string HelpFormat::make_groups(const CLI::App* app, CLI::AppFormatMode) const {
    std::string out;
    for (const std::string& group : app->get_groups()) {
        std::string entries;
        for (const CLI::Option* option : app->get_options()) {
            if (option->get_group() == group && option->nonpositional()) {
                entries += make_option(option, false);
            }
        }
        if (!entries.empty()) out += "\n" + group + ":\n" + entries;
    }
    return out;
}

std::string HelpFormat::make_usage(const CLI::App* app, std::string name) const {
    std::string out = "\nUsage: " + name;
    const bool has_commands = !app->get_subcommands({}).empty();
    if (has_commands) out += " COMMAND";
    for (const CLI::Option* option : app->get_options()) {
        if (option->get_positional()) out += " [" + option->get_name(true) + "]";
    }
    return out + " [OPTIONS]\n";
}

}  // namespace kilolux
