// SPDX-License-Identifier: Apache-2.0
// What a texture lookup should give, in double, after the OpenGL specification's section on
// texture minification and magnification.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <random>
#include <vector>

#include "host/scene/scene.h"

namespace kilolux {

/// An sRGB code as light, IEC 61966-2-1.
inline double linear_of(int srgb) {
    const double c = srgb / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

/// A grey picture of light.
struct GreyLevel {
    int width = 0;
    int height = 0;
    std::vector<double> light;

    double at(int x, int y) const {
        return light[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                     static_cast<std::size_t>(x)];
    }
};

/// The texture's levels, each the mean of 2 x 2 pixels of the one before; sides must be powers of
/// two.
inline std::vector<GreyLevel> grey_levels(int width, int height, const std::vector<int>& codes) {
    std::vector<GreyLevel> levels(1);
    levels[0] = {width, height, {}};
    for (const int code : codes) levels[0].light.push_back(linear_of(code));
    while (levels.back().width > 1 || levels.back().height > 1) {
        const GreyLevel& from = levels.back();
        GreyLevel to{std::max(from.width / 2, 1), std::max(from.height / 2, 1), {}};
        for (int y = 0; y < to.height; ++y) {
            for (int x = 0; x < to.width; ++x) {
                const int x1 = std::min(2 * x + 1, from.width - 1);
                const int y1 = std::min(2 * y + 1, from.height - 1);
                const int x0 = std::min(2 * x, x1);
                const int y0 = std::min(2 * y, y1);
                to.light.push_back(
                    (from.at(x0, y0) + from.at(x1, y0) + from.at(x0, y1) + from.at(x1, y1)) / 4);
            }
        }
        levels.push_back(std::move(to));
    }
    return levels;
}

inline int wrapped(Wrap wrap, int i, int size) {
    if (wrap == Wrap::clamp) return std::clamp(i, 0, size - 1);
    const int period = wrap == Wrap::mirror ? 2 * size : size;
    const int inside = ((i % period) + period) % period;
    return inside < size ? inside : period - 1 - inside;
}

/// A level at texture coordinates `uv`.
inline double sample_level(const GreyLevel& level, const Sampler& sampler, Filter filter,
                           const glm::dvec2& uv) {
    const auto texel = [&](int x, int y) {
        return level.at(wrapped(sampler.wrap_s, x, level.width),
                        wrapped(sampler.wrap_t, y, level.height));
    };
    const double x = uv.x * level.width;
    const double y = uv.y * level.height;
    if (filter == Filter::nearest) {
        return texel(static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)));
    }
    const int x0 = static_cast<int>(std::floor(x - 0.5));
    const int y0 = static_cast<int>(std::floor(y - 0.5));
    const double fx = x - 0.5 - x0;
    const double fy = y - 0.5 - y0;
    return (1 - fy) * ((1 - fx) * texel(x0, y0) + fx * texel(x0 + 1, y0)) +
           fy * ((1 - fx) * texel(x0, y0 + 1) + fx * texel(x0 + 1, y0 + 1));
}

/// The texture at `uv` where a pixel is 2^lod texels wide.
inline double sample_texture(const std::vector<GreyLevel>& levels, const Sampler& sampler,
                             const glm::dvec2& uv, double lod) {
    if (lod <= 0.0) return sample_level(levels[0], sampler, sampler.magnify, uv);
    if (!sampler.mipmaps) return sample_level(levels[0], sampler, sampler.minify, uv);
    const auto last = static_cast<double>(levels.size() - 1);
    const auto level = [&](double index) {
        return sample_level(levels[static_cast<std::size_t>(std::min(index, last))], sampler,
                            sampler.minify, uv);
    };
    if (sampler.between_mipmaps == Filter::nearest) return level(std::round(lod));
    const double low = std::floor(lod);
    return (1 - (lod - low)) * level(low) + (lod - low) * level(low + 1);
}

/// A grey texture of noise; the codes of `seed` are always the same.
inline std::vector<int> noise_codes(int width, int height, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<int> codes;
    for (int i = 0; i < width * height; ++i) codes.push_back(static_cast<int>(random() >> 24));
    return codes;
}

inline std::vector<std::uint8_t> grey_rgba(const std::vector<int>& codes) {
    std::vector<std::uint8_t> rgba;
    for (const int code : codes) {
        const auto value = static_cast<std::uint8_t>(code);
        rgba.insert(rgba.end(), {value, value, value, 255});
    }
    return rgba;
}

}  // namespace kilolux
