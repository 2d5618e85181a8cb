// SPDX-License-Identifier: Apache-2.0
// What JSON takes in memory, on 64 bits with glibc: blocks of 16 bytes with 8 for malloc's own. The
// numbers are those of nlohmann::json 3 with std::map, and of tinygltf 2.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

namespace kilolux {

/// What a JSON text has. What makes parsing fail comes after all that is in memory by then, so the
/// counts of any text bound it.
struct JsonCounts {
    std::uint64_t objects = 0;
    std::uint64_t arrays = 0;
    std::uint64_t members = 0;         // of objects
    std::uint64_t elements = 0;        // of arrays
    std::uint64_t most_elements = 0;   // of one array
    std::uint64_t strings = 0;         // that are values
    std::uint64_t longest_string = 0;  // [byte]
    std::uint64_t string_bytes = 0;    // of strings and keys that do not fit into std::string

    void add_string(std::uint64_t length);
};

/// Bound of what parsing takes [byte].
std::uint64_t bound_of_parsed(const JsonCounts& counts);

/// [byte]
struct JsonCost {
    std::uint64_t values = 0;  // the parsed values themselves
    std::uint64_t text = 0;    // bound of their text
    std::uint64_t model = 0;   // bound of what tinygltf::Model and placing its nodes take
    std::uint64_t longest_string = 0;

    void add(const JsonCost& other);
};

/// The cost of an object or array of a glTF file.
JsonCost cost_of(const nlohmann::json& value);

}  // namespace kilolux
