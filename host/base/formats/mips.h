// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "kernels/shared/surface_scene.h"

namespace kilolux {

/// The next mip level's size.
uint halved(uint size);

/// Texels of an image with all its mip levels.
std::size_t mip_texels(uint width, uint height);

/// Sets size, levels and places of an image whose levels begin at `first_texel`.
void place_mips(TextureRow& row, uint width, uint height, std::size_t first_texel);

/// The linear value of an 8-bit colour channel's code in 65535ths.
std::array<std::uint16_t, 256> linear_codes(bool srgb);

}  // namespace kilolux
