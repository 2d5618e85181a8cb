// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

namespace kilolux {

/// GLFW's key for KeyboardEvent.code of the DOM, both by place on the keyboard; none: not known.
std::optional<int> key_of_code(std::string_view code);

}  // namespace kilolux
