// SPDX-License-Identifier: Apache-2.0
#include "present/config_file.h"

#include <fmt/format.h>

#include <CLI/Config.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "host/base/error.h"
#include "host/base/suggest.h"
#include "host/base/system/read_text.h"
#include "present/program.h"

namespace kilolux {
namespace {

using Json = nlohmann::ordered_json;
using Entries = std::vector<std::pair<std::string, std::string>>;  // option's name and text

std::string value_text(const std::filesystem::path& file, const std::string& name,
                       const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number() || value.is_boolean()) return value.dump();
    if (!value.is_array()) {
        throw UsageError(
            fmt::format("{}: {}: '{}' is no text, number, true, false or array of them",
                        file.string(), name, value.dump()));
    }
    std::vector<std::string> parts;
    for (const Json& part : value) parts.push_back(value_text(file, name, part));
    return joined(parts, ",");
}

Entries json_entries(const std::filesystem::path& file, const std::string& text) {
    std::vector<std::string> names;  // a parsed object has each name once
    const auto note_name = [&names](int depth, Json::parse_event_t event, const Json& name) {
        if (event == Json::parse_event_t::key && depth == 1) names.push_back(name);
        return true;
    };
    const Json root = Json::parse(text, note_name, false, true);
    if (root.is_discarded()) throw UsageError(file.string() + ": is not valid JSON");
    Entries entries;
    for (const std::string& name : names) {
        entries.emplace_back(name, value_text(file, name, root.at(name)));
    }
    return entries;
}

Entries toml_entries(const std::filesystem::path& file, const std::string& text) {
    std::istringstream in(text);
    Entries entries;
    for (const CLI::ConfigItem& item : CLI::ConfigTOML().from_config(in)) {
        if (item.name == "++" || item.name == "--") continue;  // CLI11's marks around a [section]
        if (!item.parents.empty()) {
            throw UsageError(fmt::format("{}: [{}]: there are no sections", file.string(),
                                         joined(item.parents, ".")));
        }
        entries.emplace_back(item.name, joined(item.inputs, ","));
    }
    return entries;
}

CLI::Option& option_of(CLI::App& command, const std::filesystem::path& file,
                       const std::string& name) {
    CLI::Option* option = name == "scene"
                              ? command.get_option_no_throw("SCENE")
                              : command.get_option_no_throw(name.size() > 1 ? "--" + name : name);
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

}  // namespace

void apply_config_file(CLI::App& command, const std::filesystem::path& file) {
    const std::string text = read_text(file);
    const bool is_json = trim(text).starts_with('{');
    const Entries entries = is_json ? json_entries(file, text) : toml_entries(file, text);
    std::set<std::string> seen;
    for (const auto& [name, value] : entries) {
        if (!seen.insert(name).second) {
            throw UsageError(fmt::format("{}: '{}' stands twice", file.string(), name));
        }
        apply(option_of(command, file, name), file, name, value);
    }
}

}  // namespace kilolux
