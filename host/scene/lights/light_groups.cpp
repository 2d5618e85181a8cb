// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/light_groups.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "host/base/error.h"
#include "host/base/text.h"
#include "host/scene/lights/light_kinds.h"

namespace kilolux {
namespace {

// A property of lights by which patterns choose them: `key`:GLOB; without a key GLOB is of the
// node's name.
struct LightKey {
    std::string_view key;
    std::string (*value)(const SceneLight& light, const Scene& scene);
    std::string_view meaning;
};

const LightNode* node_of(const SceneLight& light, const Scene& scene) {
    return light.node < 0 ? nullptr : &scene.light_nodes.at(static_cast<std::size_t>(light.node));
}

std::string node_name_of(const SceneLight& light, const Scene& scene) {
    const LightNode* node = node_of(light, scene);
    return node != nullptr ? node->name : "";
}

std::string extras_group_of(const SceneLight& light, const Scene& scene) {
    const LightNode* node = node_of(light, scene);
    return node != nullptr ? node->group : "";
}

std::string web_name_of(const SceneLight& light, const Scene& scene) {
    if (light.profile < 0) return "";
    return scene.webs[scene.aimed_profiles[static_cast<std::size_t>(light.profile)].web].name;
}

std::string kind_name_of(const SceneLight& light, const Scene&) {
    return std::string(kind_of(light).name);
}

std::string origin_of(const SceneLight& light, const Scene&) {
    if (light.of_surface) return "surfaces";
    return light.node < 0 ? "generated" : "file";
}

constexpr LightKey kLightKeys[] = {
    {"", node_name_of, "name of the node"},
    {"kind", kind_name_of, "point, spot, directional, rect, disk, sphere, triangle"},
    {"group", extras_group_of, "extras.group of the node, else of its light"},
    {"ies", web_name_of, "name of the photometric web"},
    {"from", origin_of, "file, surfaces, generated"},
};

const LightKey* find_key(std::string_view key) {
    const auto* found = std::ranges::find(kLightKeys, key, &LightKey::key);
    return found != std::end(kLightKeys) ? found : nullptr;
}

std::vector<std::string> words_of(std::string_view text, char separator) {
    const std::vector<std::string_view> parts = split(text, separator);
    return {parts.begin(), parts.end()};
}

std::pair<std::string, std::string> split_pattern(const std::string& pattern) {
    const std::size_t colon = pattern.find(':');
    if (colon == std::string::npos) return {"", pattern};
    return {pattern.substr(0, colon), pattern.substr(colon + 1)};
}

bool matches(const SceneLight& light, const Scene& scene, const std::string& pattern) {
    const auto [key, glob] = split_pattern(pattern);
    const std::string value = find_key(key)->value(light, scene);
    return !value.empty() && fnmatch(glob.c_str(), value.c_str(), 0) == 0;
}

bool is_in(const SceneLight& light, const Scene& scene, const LightGroup& group) {
    if (std::ranges::find(group.nodes, light.node) != group.nodes.end()) return true;
    return std::ranges::any_of(
        group.patterns, [&](const std::string& pattern) { return matches(light, scene, pattern); });
}

bool is_name_letter(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_';
}

void check_name(const std::string& option, const std::string& name) {
    const bool has_letters = !name.empty() && std::ranges::all_of(name, is_name_letter);
    if (has_letters && name != kRestGroup) return;
    throw UsageError(fmt::format(
        "{}: '{}' is no name of a group; it has letters, digits, - and _, and is not {}", option,
        name, kRestGroup));
}

LightGroup parse_group(const std::string& option, const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) {
        throw UsageError(fmt::format("{}: '{}' is not NAME=PATTERN", option, text));
    }
    LightGroup out{text.substr(0, equals), words_of(text.substr(equals + 1), '+'), {}};
    check_name(option, out.name);
    for (const std::string& pattern : out.patterns) {
        const auto [key, glob] = split_pattern(pattern);
        if (find_key(key) != nullptr && !glob.empty()) continue;
        throw UsageError(fmt::format("{}: {}: '{}' is no pattern; {}", option, out.name, pattern,
                                     light_pattern_meaning()));
    }
    return out;
}

// A name for a group of one light, as check_name() asks.
std::string name_of_light(const Scene& scene, int node, std::set<std::string>& taken) {
    std::string name = scene.light_nodes[static_cast<std::size_t>(node)].name;
    std::ranges::replace_if(
        name, [](char c) { return !is_name_letter(c); }, '_');
    if (name.empty()) name = fmt::format("node{}", node);
    while (name == kRestGroup || taken.contains(name)) name += fmt::format("_{}", node);
    taken.insert(name);
    return name;
}

std::vector<LightGroup> group_of_each(const Scene& scene) {
    std::vector<LightGroup> out;
    std::set<std::string> taken;
    std::set<int> nodes;
    for (const SceneLight& light : scene.lights) {
        if (light.node < 0 || !nodes.insert(light.node).second) continue;
        if (out.size() == kMostLightGroups) {
            throw UsageError(fmt::format(
                "light groups: the scene has more than {} lights; give groups by NAME=PATTERN",
                kMostLightGroups));
        }
        out.push_back({name_of_light(scene, light.node, taken), {}, {light.node}});
    }
    return out;
}

}  // namespace

std::string light_pattern_meaning() {
    std::string out = "a pattern is";
    for (const LightKey& key : kLightKeys) {
        out += key.key.empty() ? fmt::format(" GLOB ({})", key.meaning)
                               : fmt::format(", {}:GLOB ({})", key.key, key.meaning);
    }
    return out;
}

std::vector<LightGroup> parse_light_groups(const std::string& option, const std::string& text) {
    std::vector<LightGroup> out;
    if (text.empty() || text == "none") return out;
    if (text == kEachLight) return {{std::string(kEachLight), {}, {}}};
    for (const std::string& part : words_of(text, ',')) {
        LightGroup group = parse_group(option, part);
        if (std::ranges::count(out, group.name, &LightGroup::name) > 0) {
            throw UsageError(fmt::format("{}: two groups are named '{}'", option, group.name));
        }
        out.push_back(std::move(group));
    }
    return out;
}

std::string text_of(const std::vector<LightGroup>& groups) {
    std::string out;
    for (const LightGroup& group : groups) {
        if (!out.empty()) out += ',';
        out += group.name;
        if (!group.patterns.empty()) out += '=' + joined(group.patterns, "+");
    }
    return out;
}

std::vector<LightGroup> light_groups_of(const Scene& scene, const LightOptions& generated,
                                        const std::vector<LightGroup>& asked) {
    const bool each = asked.size() == 1 && asked[0].name == kEachLight && asked[0].patterns.empty();
    std::vector<LightGroup> out = each ? group_of_each(scene) : asked;
    if (each && out.empty()) throw UsageError("light groups: the scene's file has no lights");
    if (out.size() > kMostLightGroups) {
        throw UsageError(
            fmt::format("light groups: {} are more than {}", out.size(), kMostLightGroups));
    }
    std::vector<std::size_t> lights(out.size() + 1);
    for (const SceneLight& light : scene.lights) ++lights[group_of(light, scene, out)];
    if (generated.count > 0) ++lights[group_of(generated_light(generated), scene, out)];
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (lights[i + 1] > 0) continue;
        throw UsageError(fmt::format("light groups: no light is in '{}' ({})", out[i].name,
                                     joined(out[i].patterns, "+")));
    }
    return out;
}

std::uint8_t group_of(const SceneLight& light, const Scene& scene,
                      std::span<const LightGroup> groups) {
    for (std::size_t i = 0; i < groups.size(); ++i) {
        if (is_in(light, scene, groups[i])) return static_cast<std::uint8_t>(i + 1);
    }
    return 0;
}

SceneLight generated_light(const LightOptions& options) {
    SceneLight out;
    if (options.size > 0.0) out.type = LightType::sphere;
    return out;
}

GroupNumbers::Asked GroupNumbers::asked_of(const SceneLight& light, const Scene& scene) {
    const bool has_web = light.profile >= 0;
    const auto profile = static_cast<std::size_t>(light.profile);
    return {light.node, has_web ? static_cast<int>(scene.aimed_profiles[profile].web) : -1,
            light.type, light.of_surface};
}

const std::vector<std::uint8_t>& GroupNumbers::of(const Scene& scene,
                                                  const std::vector<LightGroup>& groups) {
    if (groups != groups_) asked_.clear();
    groups_ = groups;
    numbers_.resize(scene.lights.size());
    std::vector<Asked> asked;
    asked.reserve(numbers_.size());
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
        asked.push_back(asked_of(scene.lights[i], scene));
        const bool is_known = i < asked_.size() && asked_[i] == asked[i];
        if (!is_known) numbers_[i] = group_of(scene.lights[i], scene, groups);
    }
    asked_ = std::move(asked);
    return numbers_;
}

}  // namespace kilolux
