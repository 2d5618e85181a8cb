// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/json/animated_property.h"

#include <algorithm>
#include <charconv>
#include <tuple>

#include "host/base/log.h"
#include "host/scene/gltf/choices.h"
#include "host/scene/gltf/extensions.h"
#include "host/scene/gltf/nodes.h"
#include "host/scene/gltf/rules.h"

namespace kilolux {
namespace {

using nlohmann::json;

constexpr std::string_view kPointerExtension = "KHR_animation_pointer";

// Properties of nodes and meshes, which are not kept as JSON.
struct ModelProperty {
    std::string_view array;
    std::string_view path;
    std::size_t length;  // 0: any number
};

constexpr auto kModelProperties = std::to_array<ModelProperty>({
    {"nodes", "translation", 3},
    {"nodes", "rotation", 4},
    {"nodes", "scale", 3},
    {"nodes", "weights", 0},
    {"nodes", kVisibilityPath, 1},
    {"meshes", "weights", 0},
});

// An index as JSON pointers have it: digits without a leading zero (RFC 6901, section 4).
bool is_index(std::string_view part, std::size_t& index) {
    const char* end = part.data() + part.size();
    const auto [rest, error] = std::from_chars(part.data(), end, index);
    return rest == end && error == std::errc() && (part.front() != '0' || part.size() == 1);
}

// A JSON pointer as an array, the element's index and a path within it.
std::optional<AnimatedProperty> split_pointer(std::string_view pointer) {
    AnimatedProperty out;
    bool has_element = false;
    while (pointer.starts_with('/')) {
        pointer.remove_prefix(1);
        const std::string_view part = pointer.substr(0, pointer.find('/'));
        pointer.remove_prefix(part.size());
        std::string& path = has_element ? out.path : out.array;
        if (!has_element && is_index(part, out.element)) {
            has_element = true;
        } else {
            path.append(path.empty() ? "" : ".").append(part);
        }
    }
    if (!has_element || !pointer.empty()) return {};
    return out;
}

// Images are made of it, once.
bool is_baked(const AnimatedProperty& property) {
    return property.path == "extensions.KHR_materials_pbrSpecularGlossiness.glossinessFactor";
}

// Finds the property of an element that is kept as JSON among the numbers of the rules.
bool find_in_json(AnimatedProperty& property, const json& element) {
    static const std::vector<GltfRule> rules = gltf_rules();
    const auto rule =
        std::ranges::find(rules, property.array + "[]." + property.path, &GltfRule::path);
    if (rule == rules.end() || is_baked(property)) return false;
    if (rule->kind != JsonKind::number && rule->kind != JsonKind::numbers) return false;
    property.length = rule->kind == JsonKind::number ? 1 : rule->length;
    // An extension or a texture that the file lacks has no properties; pbrMetallicRoughness does.
    const std::size_t end = property.path.rfind('.');
    if (end == std::string::npos) return true;
    const std::string_view parent = std::string_view(property.path).substr(0, end);
    return parent == "pbrMetallicRoughness" || find_member(element, parent) != nullptr;
}

bool find_in_model(AnimatedProperty& property, const tinygltf::Model& model) {
    const auto found = std::ranges::find_if(kModelProperties, [&](const ModelProperty& row) {
        return row.array == property.array && row.path == property.path;
    });
    if (found == kModelProperties.end()) return false;
    property.length = found->length;
    const bool of_nodes = property.array == "nodes";
    if (property.element >= (of_nodes ? model.nodes.size() : model.meshes.size())) return false;
    return property.path != kVisibilityPath ||
           model.nodes[property.element].extensions.contains("KHR_node_visibility");
}

std::string pointer_of(const tinygltf::AnimationChannel& channel) {
    if (channel.target_path != "pointer") return "";
    const auto* extension =
        find_extension(channel.target_extensions, std::string(kPointerExtension));
    return extension == nullptr ? "" : member_or<std::string>(*extension, "pointer", "");
}

// What a channel names that is not read; empty for none, which the format allows.
std::string name_of_unread(const tinygltf::AnimationChannel& channel) {
    const bool names_nothing = channel.target_node < 0 && channel.target_path != "pointer";
    if (names_nothing) return "";
    const std::string pointer = pointer_of(channel);
    return fmt::format("'{}'", shown_uri(pointer.empty() ? channel.target_path : pointer));
}

// "the translation of nodes[2] 'lamp'".
std::string property_name(const GltfDocument& document, const AnimatedProperty& property) {
    return fmt::format("the {} of {}", shown_uri(property.path),
                       property.array == "nodes"
                           ? node_name(document, property.element)
                           : element_name(property.array.c_str(), property.element));
}

// The first of equal reports, and how many follow.
struct Several {
    std::string first{};
    std::size_t count = 0;
    void add(std::string text) {
        if (count++ == 0) first = std::move(text);
    }
    std::string text(const char* others) const {
        return count < 2 ? first : fmt::format("{}, and {} more{}", first, count - 1, others);
    }
};

}  // namespace

std::optional<AnimatedProperty> animated_property(const GltfDocument& document,
                                                  const tinygltf::AnimationChannel& channel) {
    std::optional<AnimatedProperty> out;
    if (channel.target_node >= 0) {
        out = {.array = "nodes",
               .element = static_cast<std::size_t>(channel.target_node),
               .path = channel.target_path};
    } else {
        out = split_pointer(pointer_of(channel));
    }
    if (!out) return {};
    const auto* elements = json_elements(document, out->array);
    const bool is_found = elements == nullptr ? find_in_model(*out, document.model)
                                              : out->element < elements->size() &&
                                                    find_in_json(*out, (*elements)[out->element]);
    return is_found ? out : std::nullopt;
}

std::vector<AnimatedProperty> list_animated_properties(const GltfDocument& document) {
    std::vector<AnimatedProperty> out;
    std::map<std::tuple<std::string, std::size_t, std::string>, std::size_t> clip_of;
    Several unread, doubled;
    for (const std::size_t clip : document.clips) {
        const auto& channels = document.model.animations[clip].channels;
        for (std::size_t c = 0; c < channels.size(); ++c) {
            auto property = animated_property(document, channels[c]);
            if (!property) {
                const std::string name = name_of_unread(channels[c]);
                if (!name.empty()) unread.add(name);
                continue;
            }
            property->clip = clip;
            property->channel = c;
            const auto [entry, is_new] =
                clip_of.try_emplace({property->array, property->element, property->path}, clip);
            if (is_new) {
                out.push_back(std::move(*property));
            } else if (entry->second != clip) {
                doubled.add(
                    fmt::format("clips {} and {} both drive {}", clip_name(document, entry->second),
                                clip_name(document, clip), property_name(document, *property)));
            }
        }
    }
    if (unread.count > 0) document.leave_out("left out: animations of " + unread.text(""));
    if (doubled.count > 0) {
        warn(fmt::format("{}: {}; the clip named first counts", document.base.file,
                         doubled.text(" properties are driven twice")));
    }
    return out;
}

void set_property(json& element, const AnimatedProperty& property,
                  const std::vector<double>& values) {
    std::string path = "/" + property.path;
    std::ranges::replace(path, '.', '/');
    element[json::json_pointer(path)] = property.length == 1 ? json(values[0]) : json(values);
}

}  // namespace kilolux
