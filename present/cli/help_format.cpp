// SPDX-License-Identifier: Apache-2.0
#include "present/cli/help_format.h"

#include <algorithm>
#include <sstream>
#include <vector>

namespace kilolux {
namespace {

constexpr std::size_t kPageWidth = 80;
constexpr std::size_t kTextColumn = 30;
constexpr char kFixedSpace = '\x1f';  // no line ends here

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
    for (std::string& line : lines) std::replace(line.begin(), line.end(), kFixedSpace, ' ');
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

std::string option_entry(const CLI::Option& option) {
    std::string text = option.get_description();
    if (!option.get_default_str().empty()) {
        text += " [default:" + std::string(1, kFixedSpace) + option.get_default_str() + "]";
    }
    return help_entry(option.get_positional() ? option.get_name(true) : option_head(option), text);
}

std::string usage(const CLI::App& app, const std::string& name) {
    std::string out = "Usage: " + name;
    if (!app.get_subcommands({}).empty()) out += " COMMAND";
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_positional()) out += " [" + option->get_name(true) + "]";
    }
    return out + " [OPTIONS]\n";
}

std::string commands(const CLI::App& app) {
    std::string out;
    for (const CLI::App* command : app.get_subcommands({})) {
        out += help_entry(command->get_name(), command->get_description());
    }
    return out.empty() ? out : "\nCommands:\n" + out;
}

std::string options(const CLI::App& app) {
    std::string out;
    for (const std::string& group : app.get_groups()) {
        out += "\n" + group + ":\n";
        for (const CLI::Option* option : app.get_options()) {
            if (option->get_group() == group) out += option_entry(*option);
        }
    }
    return out;
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

std::string HelpFormat::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode) const {
    return app->get_description() + "\n\n" + usage(*app, name) + commands(*app) + options(*app) +
           "\n" + app->get_footer() + "\n";
}

}  // namespace kilolux
