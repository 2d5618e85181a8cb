// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/check.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "host/base/error.h"

namespace kilolux {
namespace {

using nlohmann::json;

// Deeper than any sane file; readers of JSON may recurse.
constexpr int kMaxDepth = 100;

std::string shown(const json& value) {
    constexpr std::size_t kLongest = 40;
    if (value.is_array() && value.size() > 16) return fmt::format("an array of {}", value.size());
    if (value.is_object()) return "an object";
    const std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
    return text.size() > kLongest ? text.substr(0, kLongest) + "..." : text;
}

std::string range_text(const GltfRule& rule) {
    const bool low = std::isfinite(rule.min);
    const bool high = std::isfinite(rule.max);
    if (low && high) return fmt::format(" from {} to {}", rule.min, rule.max);
    if (low) return fmt::format(" of at least {}", rule.min);
    return high ? fmt::format(" of at most {}", rule.max) : "";
}

// tinygltf keeps an extension's integers in 32 bits; larger ones must be floating point.
void make_wide_integer_float(json& value) {
    constexpr double kMaxInt = 2147483647.0;
    if (!value.is_number_integer() || std::abs(value.get<double>()) <= kMaxInt) return;
    value = value.get<double>();
}

// One check of a file: its document, and the place that is being looked at.
struct Checker {
    const std::string& name;
    std::size_t target_count = 0;  // of the array that the rule's indices point into

    [[noreturn]] void fail(const std::string& where, const json& value,
                           const std::string& expected) const {
        throw Error(name + ": " + where + " is " + shown(value) + ", must be " + expected);
    }
    void visit(const GltfRule& rule, json& value, std::string_view path, const std::string& where);
    void check(const GltfRule& rule, json& value, const std::string& where) const;
    void check_integer(const GltfRule& rule, json& value, const std::string& where) const;
    void check_index(const GltfRule& rule, json& value, const std::string& where) const;
    void check_numbers(const GltfRule& rule, json& value, const std::string& where) const;
    void check_choice(const GltfRule& rule, json& value, const std::string& where) const;
};

void make_whole_number_integer(json& value) {
    constexpr double kExact = 9007199254740992.0;  // 2^53
    if (!value.is_number_float()) return;
    const double number = value.get<double>();
    if (number == std::floor(number) && std::abs(number) <= kExact) {
        value = static_cast<std::int64_t>(number);
    }
}

void Checker::check_integer(const GltfRule& rule, json& value, const std::string& where) const {
    make_whole_number_integer(value);
    const bool fits = value.is_number_integer() && value.get<double>() >= rule.min &&
                      value.get<double>() <= rule.max;
    if (!fits) fail(where, value, "an integer" + range_text(rule));
}

void Checker::check_index(const GltfRule& rule, json& value, const std::string& where) const {
    make_whole_number_integer(value);
    const bool fits = value.is_number_integer() && value.get<double>() >= 0 &&
                      value.get<double>() < static_cast<double>(target_count);
    if (fits) return;
    const std::string what = rule.target.substr(rule.target.rfind('/') + 1);
    fail(where, value, fmt::format("an index into the {} {}", target_count, what));
}

void Checker::check_numbers(const GltfRule& rule, json& value, const std::string& where) const {
    const bool fits =
        value.is_array() && (rule.length == 0 || value.size() == rule.length) &&
        std::all_of(value.begin(), value.end(), [](const json& v) { return v.is_number(); });
    const std::string count = rule.length == 0 ? "" : fmt::format("{} ", rule.length);
    if (!fits) fail(where, value, "an array of " + count + "numbers");
    for (json& number : value) make_wide_integer_float(number);
}

void Checker::check_choice(const GltfRule& rule, json& value, const std::string& where) const {
    make_whole_number_integer(value);
    const std::string text = value.is_string()   ? value.get<std::string>()
                             : value.is_number() ? value.dump()
                                                 : std::string();
    if (std::find(rule.allowed.begin(), rule.allowed.end(), text) != rule.allowed.end()) return;
    std::string list;
    for (const std::string& allowed : rule.allowed) list += (list.empty() ? "" : ", ") + allowed;
    fail(where, value, "one of " + list);
}

void Checker::check(const GltfRule& rule, json& value, const std::string& where) const {
    switch (rule.kind) {
        case JsonKind::object:
            if (!value.is_object()) fail(where, value, "an object");
            return;
        case JsonKind::text:
            if (!value.is_string()) fail(where, value, "a string");
            return;
        case JsonKind::boolean:
            if (!value.is_boolean()) fail(where, value, "true or false");
            return;
        case JsonKind::number:
            if (!value.is_number()) fail(where, value, "a number");
            return make_wide_integer_float(value);
        case JsonKind::integer:
            return check_integer(rule, value, where);
        case JsonKind::index:
            return check_index(rule, value, where);
        case JsonKind::numbers:
            return check_numbers(rule, value, where);
        case JsonKind::choice:
            return check_choice(rule, value, where);
    }
}

// Follows what is left of the rule's path; `where` says how `value` was reached.
void Checker::visit(const GltfRule& rule, json& value, std::string_view path,
                    const std::string& where) {
    if (path.empty()) return check(rule, value, where);
    if (path.starts_with("[]")) {
        if (!value.is_array()) fail(where, value, "an array");
        for (std::size_t i = 0; i < value.size(); ++i) {
            visit(rule, value[i], path.substr(2), fmt::format("{}[{}]", where, i));
        }
        return;
    }
    if (path.front() == '.') path.remove_prefix(1);
    if (!value.is_object()) fail(where.empty() ? "the file" : where, value, "an object");
    const std::string prefix = where.empty() ? "" : where + ".";
    if (path.starts_with("{}")) {
        for (auto& [key, member] : value.items()) {
            visit(rule, member, path.substr(2), prefix + shown(key));
        }
        return;
    }
    const std::size_t end = std::min(path.find_first_of(".[{"), path.size());
    const std::string key(path.substr(0, end));
    const std::string_view rest = path.substr(end);
    const auto member = value.find(key);
    if (member != value.end()) return visit(rule, *member, rest, prefix + key);
    if (rule.required && rest.empty()) throw Error(name + ": " + prefix + key + " is missing");
}

// Levels of arrays and objects; counted on the text because JSON readers may recurse, and the
// parser's own callback costs time quadratic in an array's length.
int nesting_depth(const std::string& text) {
    int depth = 0;
    int deepest = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string) {
            if (c == '\\') ++i;
            in_string = c != '"';
        } else if (c == '"') {
            in_string = true;
        } else if (c == '[' || c == '{') {
            deepest = std::max(deepest, ++depth);
        } else if (c == ']' || c == '}') {
            --depth;
        }
    }
    return deepest;
}

json parse(const std::string& text, const std::string& name) {
    if (nesting_depth(text) > kMaxDepth) {
        throw Error(fmt::format("{}: JSON is nested deeper than {} levels", name, kMaxDepth));
    }
    try {
        return json::parse(text);
    } catch (const json::exception& error) {
        const std::string what = error.what();
        throw Error(name + ": is not JSON: " + what.substr(what.find(']') + 2));
    }
}

}  // namespace

json parse_gltf_json(const std::string& text, const std::string& name) {
    json root = parse(text, name);
    for (const GltfRule& rule : gltf_rules()) {
        Checker checker{name};
        const json::json_pointer target(rule.target);
        if (rule.kind == JsonKind::index && root.contains(target)) {
            checker.target_count = root.at(target).size();
        }
        checker.visit(rule, root, rule.path, "");
    }
    return root;
}

}  // namespace kilolux
