// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "host/scene/scene.h"

namespace kilolux {

/// The one buffer of a glTF file that is being written, with its views and accessors.
class ExportBuffer {
 public:
    /// Floats as an accessor of `components` per vertex (1: SCALAR, 2 to 4: VECn); its index.
    /// `bounded`: with the min and max that glTF requires of positions.
    int add_vertices(std::span<const float> values, int components, bool bounded = false);

    /// Triangle corners, in 16 bits where the largest index allows; the accessor's index.
    int add_indices(std::span<const std::uint32_t> indices);

    /// An embedded file; the buffer view's index.
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
