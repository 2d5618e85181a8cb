// SPDX-License-Identifier: Apache-2.0
#include "host/base/formats/mips.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "host/base/formats/srgb.h"

namespace kilolux {

uint halved(uint size) { return std::max(size / 2, 1u); }

std::size_t mip_texels(uint width, uint height) {
    std::size_t texels = std::size_t{width} * height;
    while (width > 1 || height > 1) {
        width = halved(width);
        height = halved(height);
        texels += std::size_t{width} * height;
    }
    return texels;
}

void place_mips(TextureRow& row, uint width, uint height, std::size_t first_texel) {
    row.width = width;
    row.height = height;
    row.levels = static_cast<uint>(std::bit_width(std::max(width, height)));
    row.first_texel = static_cast<uint>(first_texel);
    std::size_t offset = 0;
    for (uint level = 0; level < row.levels; ++level) {
        row.level_offset[level] = static_cast<uint>(offset);
        offset += std::size_t{width} * height;
        width = halved(width);
        height = halved(height);
    }
}

std::array<std::uint16_t, 256> linear_codes(bool srgb) {
    std::array<std::uint16_t, 256> out{};
    for (std::size_t code = 0; code < out.size(); ++code) {
        const double value = static_cast<double>(code) / 255.0;
        const double linear = srgb ? srgb_to_linear(value) : value;
        out[code] = static_cast<std::uint16_t>(std::lround(65535.0 * linear));
    }
    return out;
}

}  // namespace kilolux
