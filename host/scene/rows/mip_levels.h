// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/base/formats/mips.h"

namespace kilolux {

/// The mip levels of an 8-bit image, to the bit as build_mips makes them: linear, 16 bits a
/// channel, red lowest. `rgba`: rows from the top. `srgb`: colours are sRGB codes.
std::vector<std::uint64_t> mip_levels(std::span<const std::uint8_t> rgba, uint width, uint height,
                                      bool srgb);

}  // namespace kilolux
