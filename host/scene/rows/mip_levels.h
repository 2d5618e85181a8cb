// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "host/scene/scene.h"

namespace kilolux {

/// An image as devices store it: linear, 16 bits a channel, red lowest, rows from the top. `srgb`:
/// colours are sRGB codes.
std::vector<std::uint64_t> first_level(const Image& image, bool srgb);

/// The same with all mip levels, to the bit as build_mips makes them.
std::vector<std::uint64_t> mip_levels(const Image& image, bool srgb);

}  // namespace kilolux
