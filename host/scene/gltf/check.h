// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "host/scene/gltf/json/json_text.h"

namespace kilolux {

struct GltfJson {
    nlohmann::json root;
    /// Why an animation breaks a rule, by index: it matters only where it plays. Of these, `root`
    /// keeps the name.
    std::map<std::size_t, std::string> broken_animations{};
};

/// Parses and checks a glTF file's JSON, so that its readers meet only the types, ranges and
/// indices that the rules promise; a whole number written as 3.0 becomes an integer.
///
/// Throws Error "<name>: accessors[7].count is "x", must be an integer from 0 to ...".
GltfJson parse_gltf_json(const JsonText& text, const std::string& name);

}  // namespace kilolux
