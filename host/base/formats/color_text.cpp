// SPDX-License-Identifier: Apache-2.0
#include "host/base/formats/color_text.h"

#include <limits>

#include "host/base/formats/srgb.h"
#include "host/base/text.h"

namespace kilolux {

std::optional<glm::vec3> hex_color(std::string_view text) {
    const std::string_view hex = text.starts_with('#') ? text.substr(1) : text;
    const auto code = number_of<unsigned>(hex, 16);
    if (!code || hex.size() != 6) return std::nullopt;
    const auto table = srgb_to_linear_table();
    return glm::dvec3(table[*code >> 16], table[*code >> 8 & 255u], table[*code & 255u]);
}

std::optional<glm::vec3> rgb_color(std::string_view text) {
    const auto parts = split(text, ',');
    if (parts.size() != 3) return std::nullopt;
    glm::vec3 out;
    for (int i = 0; i < 3; ++i) {
        const auto value = signed_number_of<double>(parts[static_cast<std::size_t>(i)]);
        const bool is_good = value && *value >= 0.0 && *value <= std::numeric_limits<float>::max();
        if (!is_good) return std::nullopt;
        out[i] = static_cast<float>(*value);
    }
    return out;
}

}  // namespace kilolux
