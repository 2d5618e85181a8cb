// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mip_level.h"

#include <algorithm>
#include <cmath>

#include "host/base/formats/srgb.h"

namespace kilolux {
namespace {

int floor_mod(int a, int n) { return (a % n + n) % n; }

// A texel index wrapped into the image (OpenGL 4.5, 8.14.2, table 8.20).
int wrapped(int i, int size, Wrap wrap) {
    switch (wrap) {
        case Wrap::repeat:
            return floor_mod(i, size);
        case Wrap::mirror: {
            const int m = floor_mod(i, 2 * size);
            return m < size ? m : 2 * size - 1 - m;
        }
        case Wrap::clamp:
            break;
    }
    return std::clamp(i, 0, size - 1);
}

// A coordinate in texels as index and fraction; clamped, so that the index fits.
struct TexelCoordinate {
    int index;
    double fraction;
};

TexelCoordinate split_coordinate(double coordinate) {
    const double clamped = std::clamp(coordinate, -1e9, 1e9);
    const double whole = std::floor(clamped);
    return {static_cast<int>(whole), clamped - whole};
}

glm::dvec4 nearest(const MipLevel& level, const Sampler& sampler, const glm::dvec2& uv) {
    return level.texel(
        wrapped(split_coordinate(uv.x * level.width).index, level.width, sampler.wrap_s),
        wrapped(split_coordinate(uv.y * level.height).index, level.height, sampler.wrap_t));
}

glm::dvec4 bilinear(const MipLevel& level, const Sampler& sampler, const glm::dvec2& uv) {
    const TexelCoordinate s = split_coordinate(uv.x * level.width - 0.5);
    const TexelCoordinate t = split_coordinate(uv.y * level.height - 0.5);
    const auto at = [&](int i, int j) {
        return level.texel(wrapped(s.index + i, level.width, sampler.wrap_s),
                           wrapped(t.index + j, level.height, sampler.wrap_t));
    };
    return glm::mix(glm::mix(at(0, 0), at(1, 0), s.fraction),
                    glm::mix(at(0, 1), at(1, 1), s.fraction), t.fraction);
}

}  // namespace

glm::dvec4 MipLevel::texel(int x, int y) const {
    const std::size_t index =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    if (!image) return glm::dvec4(texels[index]);
    if (!image->rgba16.empty()) {
        const std::uint16_t* v = &image->rgba16[4 * index];
        return glm::dvec4(v[0], v[1], v[2], v[3]) / 65535.0;
    }
    const std::uint8_t* codes = &image->rgba[4 * index];
    const double alpha = codes[3] / 255.0;
    if (encoding == TextureEncoding::linear) {
        return {codes[0] / 255.0, codes[1] / 255.0, codes[2] / 255.0, alpha};
    }
    static const auto linear = srgb_to_linear_table();
    return {linear[codes[0]], linear[codes[1]], linear[codes[2]], alpha};
}

glm::dvec4 filtered(Filter filter, const MipLevel& level, const Sampler& sampler,
                    const glm::dvec2& uv) {
    return filter == Filter::nearest ? nearest(level, sampler, uv) : bilinear(level, sampler, uv);
}

}  // namespace kilolux
