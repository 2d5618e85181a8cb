// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string_view>

namespace kilolux {

/// "#RRGGBB" or "RRGGBB" in sRGB as linear red, green and blue, 0 to 1; none for any other text.
std::optional<glm::vec3> hex_color(std::string_view text);

/// "R,G,B", finite numbers of at least 0; none for any other text.
std::optional<glm::vec3> rgb_color(std::string_view text);

}  // namespace kilolux
