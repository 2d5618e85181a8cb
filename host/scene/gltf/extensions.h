// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/scene/gltf/document.h"

namespace kilolux {

/// Throws Error for a required extension that is unknown here, such as a compression. One warning
/// lists all that are left out, required or not, and their effect.
void check_extensions(const GltfDocument& document);

/// The extension's object in a map of extensions, or nullptr.
const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions,
                                      const std::string& name);

/// A member of an extension's object that the rules have checked, or `otherwise` without it.
template <typename T>
T member_or(const tinygltf::Value& object, const std::string& key, const T& otherwise) {
    if (!object.Has(key)) return otherwise;
    const tinygltf::Value& value = object.Get(key);
    if constexpr (std::is_same_v<T, double>) return value.GetNumberAsDouble();
    if constexpr (std::is_same_v<T, bool>) return value.template Get<bool>();
    if constexpr (std::is_same_v<T, int>) return value.GetNumberAsInt();
    if constexpr (std::is_same_v<T, std::string>) return value.template Get<std::string>();
}

/// The member's numbers; empty without it.
std::vector<double> numbers_member(const tinygltf::Value& object, const std::string& key);

}  // namespace kilolux
