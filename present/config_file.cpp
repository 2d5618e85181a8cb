// SPDX-License-Identifier: Apache-2.0
#include "present/config_file.h"

#include <fmt/format.h>

#include <CLI/Config.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/base/error.h"
#include "host/base/suggest.h"
#include "host/base/system/read_text.h"
#include "host/base/text.h"
#include "present/program.h"

namespace kilolux {
namespace {

using Json = nlohmann::ordered_json;

struct Entry {
    std::string name;  // of the option
    std::string text;  // of its value
    int line = 0;      // 0: not known
};
using Entries = std::vector<Entry>;

std::string value_text(const std::filesystem::path& file, const std::string& name,
                       const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number() || value.is_boolean()) return value.dump();
    if (!value.is_array()) {
        throw UsageError(
            fmt::format("{}: {}: '{}' must be a text, a number, true, false or an array of them",
                        file.string(), name, value.dump()));
    }
    std::vector<std::string> parts;
    for (const Json& part : value) parts.push_back(value_text(file, name, part));
    return joined(parts, ",");
}

Entries json_entries(const std::filesystem::path& file, const std::string& text) {
    // Collected here since a parsed object has each name once, with its last value.
    std::vector<std::pair<std::string, Json>> members;
    const auto note_member = [&members](int depth, Json::parse_event_t event, const Json& value) {
        using Event = Json::parse_event_t;
        if (depth != 1) return true;
        if (event == Event::key) members.emplace_back(value, nullptr);
        const bool is_whole =
            event == Event::value || event == Event::array_end || event == Event::object_end;
        if (is_whole && !members.empty()) members.back().second = value;
        return true;
    };
    const Json root = Json::parse(text, note_member, false, true);
    if (root.is_discarded()) throw UsageError(file.string() + ": is not valid JSON");
    Entries entries;
    for (const auto& [name, value] : members) {
        entries.push_back({name, value_text(file, name, value)});
    }
    return entries;
}

// Follows the brackets and strings of a TOML value from line to line.
class TomlValue {
 public:
    bool is_open() const { return depth_ > 0 || quote_.size() == 3; }

    // Takes the value's next line, and returns it without its comment.
    std::string_view add(std::string_view line) {
        if (quote_.size() == 1) quote_ = "";  // strings of one line end with it
        for (std::size_t i = 0; i < line.size(); ++i) {
            const std::string_view rest = line.substr(i);
            if (!quote_.empty()) {
                if (rest[0] == '\\' && quote_[0] == '"') {
                    ++i;
                } else if (rest.starts_with(quote_)) {
                    i += quote_.size() - 1;
                    quote_ = "";
                }
            } else if (rest[0] == '"' || rest[0] == '\'') {
                const std::string three(3, rest[0]);
                quote_ = rest.starts_with(three) ? three : three.substr(2);
                i += quote_.size() - 1;
            } else if (rest[0] == '#') {
                return line.substr(0, i);
            } else {
                depth_ += (rest[0] == '[') - (rest[0] == ']');
            }
        }
        return line;
    }

 private:
    int depth_ = 0;
    std::string quote_;  // ends the current string; empty: outside of strings
};

// The entries of a TOML text with values as they are written. To find names that stand twice:
// CLI11 joins the values of such a name.
Entries toml_lines(const std::string& text) {
    Entries entries;
    TomlValue value;
    int number = 0;
    for (const std::string_view line : split(text, '\n')) {
        ++number;
        const std::size_t equals = line.find('=');
        if (value.is_open()) {
            entries.back().text.append(" ").append(trim(value.add(line)));
        } else if (const std::string_view start = trim(line);
                   equals != line.npos && start.find_first_of("#;[") != 0) {
            std::string name(trim(line.substr(0, equals)));
            std::erase_if(name, [](char c) { return c == '"' || c == '\''; });
            const std::string_view text_of_value = trim(value.add(line.substr(equals + 1)));
            entries.push_back({name, std::string(text_of_value), number});
        }
    }
    return entries;
}

Entries toml_entries(const std::filesystem::path& file, const std::string& text) {
    std::istringstream in(text);
    Entries entries;
    for (const CLI::ConfigItem& item : CLI::ConfigTOML().from_config(in)) {
        if (item.name == "++" || item.name == "--") continue;  // CLI11's marks around a [section]
        if (!item.parents.empty()) {
            throw UsageError(fmt::format("{}: [{}]: a config file has no sections", file.string(),
                                         joined(item.parents, ".")));
        }
        entries.push_back({item.name, joined(item.inputs, ",")});
    }
    return entries;
}

CLI::Option& option_of(CLI::App& command, const std::filesystem::path& file,
                       const std::string& name) {
    CLI::Option* option = command.get_option_no_throw(name.size() > 1 ? "--" + name : name);
    if (option == nullptr && name == "scene") option = command.get_option_no_throw("SCENE");
    if (option != nullptr && name != "config" && name != "help") return *option;
    throw UsageError(fmt::format("{}: unknown option '{}'{}", file.string(), name,
                                 did_you_mean("--" + name, option_names(command))));
}

void apply(CLI::Option& option, const std::filesystem::path& file, const std::string& name,
           const std::string& text) {
    if (option.count() > 0) return;
    const bool is_flag = option.get_items_expected_max() == 0;
    if (is_flag && text != "true" && text != "false") {
        throw UsageError(
            fmt::format("{}: {}: '{}' is not true or false", file.string(), name, text));
    }
    option.add_result(text);
    option.run_callback();
}

void refuse_twice(const std::filesystem::path& file, const Entries& entries) {
    std::map<std::string, std::string> seen;
    for (const Entry& entry : entries) {
        const auto [first, is_new] = seen.emplace(entry.name, entry.text);
        if (is_new) continue;
        const std::string line = entry.line > 0 ? fmt::format(":{}", entry.line) : "";
        throw UsageError(
            fmt::format("{}{}: '{}' is given twice, as {} and as {}; give a list as an array",
                        file.string(), line, entry.name, first->second, entry.text));
    }
}

}  // namespace

void apply_config_file(CLI::App& command, const std::filesystem::path& file) {
    const std::string text = read_text(file);
    const bool is_json = trim(text).starts_with('{');
    const Entries entries = is_json ? json_entries(file, text) : toml_entries(file, text);
    refuse_twice(file, is_json ? entries : toml_lines(text));
    for (const Entry& entry : entries) {
        apply(option_of(command, file, entry.name), file, entry.name, entry.text);
    }
}

}  // namespace kilolux
