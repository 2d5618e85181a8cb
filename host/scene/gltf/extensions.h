// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/scene/gltf/document.h"

namespace kilolux {

/// Throws Error for a required extension that the loader does not know; warns of each optional one.
void check_extensions(const GltfDocument& document);

/// The extension's object in a map of extensions, or nullptr.
const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions,
                                      const std::string& name);

/// A member of an extension's object that the rules have checked, or `otherwise` without it.
double number_member(const tinygltf::Value& object, const std::string& key, double otherwise);
int integer_member(const tinygltf::Value& object, const std::string& key, int otherwise);
std::string text_member(const tinygltf::Value& object, const std::string& key,
                        const std::string& otherwise);
/// The member's numbers; empty without it.
std::vector<double> numbers_member(const tinygltf::Value& object, const std::string& key);

}  // namespace kilolux
