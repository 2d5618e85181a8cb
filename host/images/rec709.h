// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace kilolux {

/// CIE x and y of red, green, blue and white (ITU-R BT.709-6, 1.3 and 1.4), in the order of
/// ImageLayout::chromaticities.
inline constexpr std::array kRec709 = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};

}  // namespace kilolux
