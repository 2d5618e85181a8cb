// SPDX-License-Identifier: Apache-2.0
#include "host/scene/rows/mip_levels.h"

#include <tbb/parallel_for.h>

#include "kernels/shared/mips.h"

namespace kilolux {
namespace {

// The level after `above`.
void next_level(const std::uint64_t* above, uint above_width, uint above_height,
                std::uint64_t* level) {
    const uint width = halved(above_width);
    const uint height = halved(above_height);
    tbb::parallel_for(0u, height, [&](uint y) {
        const MipTaps t = mip_taps(y, height, above_height);
        const std::uint64_t* top = above + std::size_t{t.first} * above_width;
        const std::uint64_t* bottom = above + std::size_t{t.second} * above_width;
        for (uint x = 0; x < width; ++x) {
            const MipTaps s = mip_taps(x, width, above_width);
            level[std::size_t{y} * width + x] = mean_texel(
                top[s.first], top[s.second], bottom[s.first], bottom[s.second], s.share, t.share);
        }
    });
}

}  // namespace

std::vector<std::uint64_t> mip_levels(std::span<const std::uint8_t> rgba, uint width, uint height,
                                      bool srgb) {
    std::vector<std::uint64_t> out(mip_texels(width, height));
    const auto decoded = linear_codes(srgb);
    const std::size_t count = std::size_t{width} * height;
    for (std::size_t i = 0; i < count; ++i) {
        out[i] = make_texel(decoded[rgba[4 * i]], decoded[rgba[4 * i + 1]],
                            decoded[rgba[4 * i + 2]], 257u * rgba[4 * i + 3]);
    }
    std::uint64_t* above = out.data();
    while (width > 1 || height > 1) {
        std::uint64_t* level = above + std::size_t{width} * height;
        next_level(above, width, height, level);
        above = level;
        width = halved(width);
        height = halved(height);
    }
    return out;
}

}  // namespace kilolux
