// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

namespace kilolux {

/// Throws Error "<where>: ..." when a PNG file is cut off, or a part that its pixels are made from
/// is damaged or unknown: libpng would write its own complaint to standard error first.
void check_png(std::span<const unsigned char> png, const std::string& where);

}  // namespace kilolux
