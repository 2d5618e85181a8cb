// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "host/base/error.h"
#include "host/scene/gltf/files.h"
#include "host/scene/gltf/rules.h"

namespace kilolux {
namespace {

using nlohmann::json;

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
    if (rule.multiple_of > 1) {
        return fmt::format(" from {} to {} that is a multiple of {}", rule.min, rule.max,
                           rule.multiple_of);
    }
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

void make_whole_number_integer(json& value) {
    constexpr double kExact = 9007199254740992.0;  // 2^53
    if (!value.is_number_float()) return;
    const double number = value.get<double>();
    if (number == std::floor(number) && std::abs(number) <= kExact) {
        value = static_cast<std::int64_t>(number);
    }
}

bool is_integer_in(json& value, double min, double max) {
    make_whole_number_integer(value);
    return value.is_number_integer() && value.get<double>() >= min && value.get<double>() <= max;
}

bool is_integer_of(json& value, const GltfRule& rule) {
    return is_integer_in(value, rule.min, rule.max) &&
           (rule.multiple_of == 1 || value.get<std::int64_t>() % rule.multiple_of == 0);
}

bool are_numbers(json& value, std::size_t length) {
    if (!value.is_array() || (length != 0 && value.size() != length)) return false;
    for (json& number : value) {
        if (!number.is_number()) return false;
        make_wide_integer_float(number);
    }
    return true;
}

bool is_one_of(json& value, const std::vector<std::string>& allowed) {
    make_whole_number_integer(value);
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    return std::find(allowed.begin(), allowed.end(), text) != allowed.end();
}

// The path to a value from the root: by `key`, or by `index` where that is empty. Only an error
// turns it into text.
struct JsonPlace {
    const JsonPlace* parent = nullptr;
    std::string_view key{};
    std::size_t index = 0;
    bool from_file = false;  // the key is the file's own
};

std::string text_of(const JsonPlace& place) {
    if (place.parent == nullptr) return "";
    std::string out = text_of(*place.parent);
    if (place.key.empty()) return fmt::format("{}[{}]", out, place.index);
    return out + (out.empty() ? "" : ".") +
           (place.from_file ? shown(place.key) : std::string(place.key));
}

// Applies one rule to a file.
struct Checker {
    const std::string& name;  // of the file
    const GltfRule& rule;
    std::size_t target_count;  // of the array that the rule's indices point into

    [[noreturn]] void fail(const JsonPlace& place, const json& value,
                           const std::string& expected) const {
        const std::string where = text_of(place);
        throw Error(fmt::format("{}: {} is {}, must be {}", name,
                                where.empty() ? "the file" : where, shown(value), expected));
    }

    void require(bool fits, const JsonPlace& place, const json& value, const char* expected) const {
        if (!fits) fail(place, value, expected);
    }

    void check(json& value, const JsonPlace& place) const {
        switch (rule.kind) {
            case JsonKind::object:
                return require(value.is_object(), place, value, "an object");
            case JsonKind::array:
                return require(value.is_array(), place, value, "an array");
            case JsonKind::text:
                return require(value.is_string(), place, value, "a string");
            case JsonKind::boolean:
                return require(value.is_boolean(), place, value, "true or false");
            case JsonKind::number:
                require(value.is_number(), place, value, "a number");
                return make_wide_integer_float(value);
            case JsonKind::integer:
                if (is_integer_of(value, rule)) return;
                fail(place, value, "an integer" + range_text(rule));
            case JsonKind::index:
                if (is_integer_in(value, 0, static_cast<double>(target_count) - 1)) return;
                fail(place, value,
                     fmt::format("an index into the {} {}", target_count,
                                 rule.target.substr(rule.target.rfind('/') + 1)));
            case JsonKind::numbers:
                if (are_numbers(value, rule.length)) return;
                fail(place, value,
                     rule.length == 0 ? "an array of numbers"
                                      : fmt::format("an array of {} numbers", rule.length));
            case JsonKind::choice:
                if (is_one_of(value, rule.allowed)) return;
                fail(place, value, fmt::format("one of {}", fmt::join(rule.allowed, ", ")));
        }
    }

    bool applies_to(const json& object) const {
        return rule.where_type.empty() || object.value("type", json()) == rule.where_type;
    }

    // Follows the rest of the rule's path; `place` says how `value` was reached.
    void visit(json& value, std::string_view path, const JsonPlace& place) const {
        if (path.empty()) return check(value, place);
        if (path.starts_with("[]")) {
            require(value.is_array(), place, value, "an array");
            for (std::size_t i = 0; i < value.size(); ++i) {
                visit(value[i], path.substr(2), {&place, {}, i});
            }
            return;
        }
        if (path.front() == '.') path.remove_prefix(1);
        require(value.is_object(), place, value, "an object");
        if (path.starts_with("{}")) {
            for (auto& [key, member] : value.items()) {
                visit(member, path.substr(2), {&place, key, 0, true});
            }
            return;
        }
        const std::size_t end = std::min(path.find_first_of(".[{"), path.size());
        const std::string_view rest = path.substr(end);
        const JsonPlace below{&place, path.substr(0, end)};
        const auto member = value.find(below.key);
        if (member != value.end()) return visit(*member, rest, below);
        if (rule.required && rest.empty() && applies_to(value)) {
            throw Error(name + ": " + text_of(below) + " is missing");
        }
    }
};

// The parser's message, with the column in the file.
std::string parse_message(const json::exception& error, const JsonText& text) {
    constexpr std::string_view kColumn = ", column ";
    std::string what = error.what();
    what.erase(0, what.find(']') + 2);
    const auto* broken = dynamic_cast<const json::parse_error*>(&error);
    const std::size_t place = what.find(kColumn);
    if (broken == nullptr || place == std::string::npos) return what;
    const std::size_t begin = place + kColumn.size();
    const std::size_t end = what.find_first_not_of("0123456789", begin);
    const std::size_t column = std::stoull(what.substr(begin, end - begin));
    return what.replace(begin, end - begin,
                        std::to_string(column + saved_before(text, broken->byte)));
}

json parse(const JsonText& json_text, const std::string& name) {
    if (json_text.depth > kDeepestJson) {
        throw Error(fmt::format("{}: JSON is nested deeper than {} levels", name, kDeepestJson));
    }
    try {
        return json::parse(json_text.text);
    } catch (const json::exception& error) {
        throw Error(name + ": is not JSON: " + parse_message(error, json_text));
    }
}

// Ahead of the rules, which files of another version break in many ways.
void check_version(const json& root, const std::string& name) {
    for (const char* key : {"version", "minVersion"}) {
        const json::json_pointer place = json::json_pointer("/asset") / key;
        if (!root.is_object() || !root.contains(place)) continue;
        const json& value = root.at(place);
        if (!value.is_string() && !value.is_number()) continue;
        const std::string version = value.is_string() ? value.get<std::string>() : shown(value);
        const bool is_known =
            key == std::string("version") ? version.starts_with("2.") : version == "2.0";
        if (is_known || (value.is_number() && version.starts_with("2"))) continue;
        const char* hint =
            version.starts_with("1") ? "; gltf-pipeline -i old.gltf -o new.gltf converts it" : "";
        throw Error(fmt::format("{}: asset.{} is '{}', must be 2.0{}", name, key,
                                shown_uri(version), hint));
    }
}

constexpr std::string_view kAnimations = "animations";
constexpr std::string_view kAnimation = "animations[]";

// Checks each animation by itself, and notes the first error of each.
void check_animations(GltfJson& file, const Checker& checker) {
    const auto found = file.root.find(kAnimations);
    if (found == file.root.end() || !found->is_array()) {
        return checker.visit(file.root, checker.rule.path, {});
    }
    const JsonPlace top{}, all{&top, kAnimations};
    for (std::size_t i = 0; i < found->size(); ++i) {
        if (file.broken_animations.contains(i)) continue;
        try {
            const auto path = std::string_view(checker.rule.path).substr(kAnimation.size());
            checker.visit((*found)[i], path, {&all, {}, i});
        } catch (const Error& error) {
            file.broken_animations.emplace(i, error.what());
        }
    }
}

// Leaves the names of broken animations.
void empty_broken(GltfJson& file) {
    for (const auto& [index, why] : file.broken_animations) {
        json& animation = file.root.at(std::string(kAnimations))[index];
        json kept = json::object();
        if (animation.is_object() && animation.contains("name") &&
            animation.at("name").is_string()) {
            kept["name"] = animation.at("name");
        }
        animation = std::move(kept);
    }
}

}  // namespace

GltfJson parse_gltf_json(const JsonText& text, const std::string& name) {
    GltfJson out{parse(text, name)};
    json& root = out.root;
    check_version(root, name);
    for (const GltfRule& rule : gltf_rules()) {
        const json::json_pointer target(rule.target);
        const bool has_target = rule.kind == JsonKind::index && root.contains(target);
        const Checker checker{name, rule, has_target ? root.at(target).size() : 0};
        if (rule.path.starts_with(kAnimation)) {
            check_animations(out, checker);
        } else {
            checker.visit(root, rule.path, {});
        }
    }
    empty_broken(out);
    return out;
}

}  // namespace kilolux
