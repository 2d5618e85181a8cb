// SPDX-License-Identifier: Apache-2.0
#include "host/scene/rows/mip_levels.h"

#include "host/base/formats/mips.h"
#include "host/base/system/parallel.h"
#include "kernels/shared/mips.h"

namespace kilolux {
namespace {

// The level after `above`.
void next_level(const std::uint64_t* above, uint above_width, uint above_height,
                std::uint64_t* level) {
    const uint width = halved(above_width);
    const uint height = halved(above_height);
    parallel_for(0u, height, [&](uint y) {
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

std::vector<std::uint64_t> first_level(const Image& image, bool srgb) {
    const auto decoded = linear_codes(srgb);
    const auto width = static_cast<std::size_t>(image.width);
    std::vector<std::uint64_t> out(width * static_cast<std::size_t>(image.height));
    parallel_for(0, image.height, [&](int y) {
        const std::size_t first = static_cast<std::size_t>(y) * width;
        for (std::size_t i = first; i < first + width; ++i) {
            if (image.rgba.empty()) {
                const std::uint16_t* v = &image.rgba16[4 * i];
                out[i] = make_texel(v[0], v[1], v[2], v[3]);
            } else {
                const std::uint8_t* v = &image.rgba[4 * i];
                out[i] = make_texel(decoded[v[0]], decoded[v[1]], decoded[v[2]], 257u * v[3]);
            }
        }
    });
    return out;
}

std::vector<std::uint64_t> mip_levels(const Image& image, bool srgb) {
    uint width = static_cast<uint>(image.width);
    uint height = static_cast<uint>(image.height);
    std::vector<std::uint64_t> out = first_level(image, srgb);
    out.resize(mip_texels(width, height));
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
