// SPDX-License-Identifier: Apache-2.0
#include "present/help_format.h"

#include <fmt/format.h>
#include <algorithm>
#include <sstream>
#include <vector>

#include "host/base/text.h"
#include "present/cli/option_builder.h"

namespace kilolux {
namespace {

constexpr std::size_t kPageWidth = 80;
constexpr std::size_t kTextColumn = 30;
constexpr std::size_t kRowColumn = 6;  // of choices
constexpr char kFixedSpace = '\x1f';   // no line ends here

// Lines of at most `width` characters.
std::vector<std::string> wrapped(std::string_view text, std::size_t width) {
    std::istringstream words{std::string(text)};
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

// Two columns: `head` at the left margin, `text` beside it, or below when the head is too long.
// Further lines of `text` are rows of their own, indented.
std::string entry(const std::string& head, std::string_view text) {
    std::string out = "  " + head;
    if (out.size() + 2 > kTextColumn) out += "\n";
    std::size_t indent = kTextColumn;
    for (const std::string_view row : split(text, '\n')) {
        for (const std::string& line : wrapped(row, kPageWidth - indent)) {
            const std::size_t begin = out.rfind('\n') + 1;  // npos + 1 is 0
            out.resize(std::max(out.size(), begin + indent), ' ');
            out += line + "\n";
        }
        indent = kRowColumn;
    }
    return out;
}

// "--output, -o FILE": long names first, as everywhere in the program.
std::string option_head(const CLI::Option& option) {
    if (option.get_positional()) return option.get_name(true);
    std::vector<std::string> names;
    for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option.get_snames()) names.push_back("-" + name);
    std::string head = joined(names);
    if (option.get_items_expected_max() == 0) return head;
    // Words that have a row each are not listed twice.
    const bool described = option.get_description().find('\n') != std::string::npos;
    const std::string form = option.get_type_name();
    return head + " " + (!described ? form : form.ends_with(",...") ? "NAME,..." : "NAME");
}

std::string option_entry(const CLI::Option& option) {
    std::string text = option.get_description();
    if (!option.get_default_str().empty()) {
        const std::string default_text =
            fmt::format(" [default:{}{}]", kFixedSpace, option.get_default_str());
        text.insert(std::min(text.find('\n'), text.size()), default_text);
    }
    return entry(option_head(option), text);
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
        out += entry(command->get_name(), command->get_description());
    }
    return out.empty() ? out : "\nCommands:\n" + out;
}

std::string options(const CLI::App& app, bool all) {
    std::string out;
    std::vector<std::string> groups = app.get_groups();
    // The heading "General", which every command registers first, is printed last.
    if (groups.size() > 1) std::rotate(groups.begin(), groups.begin() + 1, groups.end());
    for (const std::string& group : groups) {
        if (group.ends_with(kRestSuffix) && !all) continue;
        std::string entries;
        for (const CLI::Option* option : app.get_options()) {
            if (option->get_group() == group) entries += option_entry(*option);
        }
        if (!entries.empty()) out += "\n" + group + ":\n" + entries;
    }
    return out;
}

}  // namespace

std::string HelpFormat::make_help(const CLI::App* app, std::string name,
                                  CLI::AppFormatMode mode) const {
    return app->get_description() + "\n\n" + usage(*app, name) + commands(*app) +
           options(*app, mode == CLI::AppFormatMode::All) + "\n" + app->get_footer() + "\n";
}

}  // namespace kilolux
