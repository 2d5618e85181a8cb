// SPDX-License-Identifier: Apache-2.0
// How much memory JSON takes, with nlohmann::json 3 (std::map) and tinygltf 2 on 64 bits. glibc's
// malloc rounds up to 16 bytes, of which it needs 8.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

namespace kilolux {

/// Counts of a JSON text. They also bound the memory of a text that is not valid: when parsing
/// fails, memory holds only what stands before the error.
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

/// The most memory that parsing takes [byte].
std::uint64_t bound_of_parsed(const JsonCounts& counts);

/// The memory that a JSON value takes [byte].
struct JsonCost {
    std::uint64_t values = 0;  // the parsed values
    std::uint64_t text = 0;    // at most, of them as text
    std::uint64_t model = 0;   // at most, of tinygltf::Model and of placing its nodes
    std::uint64_t longest_string = 0;

    void add(const JsonCost& other);
};

/// The cost of an object or array of a glTF file.
JsonCost cost_of(const nlohmann::json& value);

}  // namespace kilolux
