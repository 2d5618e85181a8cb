// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host/base/text.h"

namespace kilolux {

/// The word of `known` nearest to `word` in edits (insert, delete, replace, swap neighbours), if it
/// is near enough to be a typing error; else empty.
std::string nearest_word(std::string_view word, const std::vector<std::string>& known);

/// "; did you mean 'x'?" for the nearest word, or nothing.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& known);

}  // namespace kilolux
