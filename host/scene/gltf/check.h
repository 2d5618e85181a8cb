// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace kilolux {

enum class JsonKind { object, array, text, boolean, number, integer, index, numbers, choice };

/// What one property of a glTF file must be.
struct GltfRule {
    /// From the root, "[]" for every element of an array and "{}" for every member of an object:
    /// "accessors[].count", "meshes[].primitives[].attributes{}".
    std::string path;
    JsonKind kind = JsonKind::object;
    bool required = false;  // where the object that holds it is there
    double min = -std::numeric_limits<double>::infinity();
    double max = std::numeric_limits<double>::infinity();
    std::string target{};                // index: JSON pointer of the array that it points into
    std::size_t length = 0;              // numbers: how many, 0 for any
    std::vector<std::string> allowed{};  // choice: the texts or integers, as JSON writes them
    int multiple_of = 1;                 // integer
    std::string where_type{};            // the object that holds it has this "type"; empty: any
};

/// All rules for the properties that the loader reads.
std::vector<GltfRule> gltf_rules();

/// Parses and checks a glTF file's JSON, so that its readers meet only the types, ranges and
/// indices that the rules promise; a whole number written as 3.0 becomes an integer.
///
/// Throws Error "<name>: accessors[7].count is "x", must be an integer from 0 to ...".
nlohmann::json parse_gltf_json(std::string_view text, const std::string& name);

}  // namespace kilolux
