// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/gltf/document.h"

namespace kilolux {

/// The path of KHR_node_visibility in a node.
constexpr const char* kVisibilityPath = "extensions.KHR_node_visibility.visible";

/// What a channel drives, by its target's path or as KHR_animation_pointer; none for a property
/// that is not read, or that the file lacks.
std::optional<AnimatedProperty> animated_property(const GltfDocument& document,
                                                  const tinygltf::AnimationChannel& channel);

/// What the playing clips drive, each property once, by the first channel that drives it. Reports
/// what is left out, and properties that two clips drive.
std::vector<AnimatedProperty> list_animated_properties(const GltfDocument& document);

/// The elements of an array that the document keeps as JSON ("materials"), or null.
template <typename Document>
auto* json_elements(Document& document, const std::string& array) {
    if (array == "materials") return &document.materials;
    if (array == "cameras") return &document.cameras;
    for (std::size_t e = 0; e < kLightExtensions.size(); ++e) {
        if (array == fmt::format("extensions.{}.lights", kLightExtensions[e])) {
            return &document.lights[e];
        }
    }
    return static_cast<decltype(&document.materials)>(nullptr);
}

/// Gives an element that is kept as JSON the property's values.
void set_property(nlohmann::json& element, const AnimatedProperty& property,
                  const std::vector<double>& values);

}  // namespace kilolux
