// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

namespace kilolux {

/// The one buffer of a glTF file that is being written, with its views and accessors.
class ExportBuffer {
 public:
    /// Floats as an accessor of `components` a vertex (1: SCALAR, 2 .. 4: VECn); its index.
    /// `bounded`: with the min and max that glTF asks of positions.
    int add_vertices(std::span<const float> values, int components, bool bounded = false);

    /// Triangle corners, in 16 bits where the largest index allows; the accessor's index.
    int add_indices(std::span<const std::uint32_t> indices);

    /// Bytes of a file within the file; the buffer view's index.
    int add_bytes(std::span<const unsigned char> bytes);

    const std::vector<unsigned char>& bytes() const { return bytes_; }
    const nlohmann::ordered_json& views() const { return views_; }
    const nlohmann::ordered_json& accessors() const { return accessors_; }

 private:
    int add_accessor(nlohmann::ordered_json accessor);

    std::vector<unsigned char> bytes_;
    nlohmann::ordered_json views_ = nlohmann::ordered_json::array();
    nlohmann::ordered_json accessors_ = nlohmann::ordered_json::array();
};

}  // namespace kilolux
