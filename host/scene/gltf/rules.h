// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
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

}  // namespace kilolux
