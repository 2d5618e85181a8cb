// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/bake.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "host/base/system/parallel.h"

namespace kilolux {
namespace {

std::uint8_t to_byte(double x) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(x, 0.0, 1.0) * 255.0));
}

std::size_t texels(int size) {
    return static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
}

Image new_image(const std::string& name, int size) {
    return {name, size, size, std::vector<std::uint8_t>(4 * texels(size), 255)};
}

void put(Image& image, std::size_t texel, const glm::dvec3& c) {
    std::uint8_t* const to = &image.rgba[4 * texel];
    for (int i = 0; i < 3; ++i) to[i] = to_byte(c[i]);
}

// Calls `each(x, y, texel)`, rows on all cores.
void each_texel(int size, const auto& each) {
    parallel_for(0, size, [&](int y) {
        for (int x = 0; x < size; ++x) each(x, y, static_cast<std::size_t>(y * size + x));
    });
}

}  // namespace

SurfaceImages bake(const BakeOptions& options, const std::function<Texel(double, double)>& texel) {
    const int size = options.size;
    SurfaceImages out;
    out.name = options.name;
    if (options.base_color) out.base_color = new_image(options.name + "-base-color", size);
    if (options.roughness) out.roughness = new_image(options.name + "-roughness", size);
    std::vector<float> heights(options.normal ? texels(size) : 0);
    each_texel(size, [&](int x, int y, std::size_t i) {
        const Texel t = texel((x + 0.5) / size, (y + 0.5) / size);
        if (options.base_color) put(out.base_color, i, t.color);
        if (options.roughness) put(out.roughness, i, {1.0, t.roughness, 0.0});
        if (options.normal) heights[i] = static_cast<float>(t.height);
    });
    if (options.normal) {
        out.normal = normal_map(options.name + "-normal", heights, size, options.metres);
    }
    return out;
}

Image normal_map(const std::string& name, const std::vector<float>& heights, int size,
                 double metres) {
    Image out = new_image(name, size);
    const auto height = [&](int x, int y) {
        const int row = (y + size) % size;
        return heights[static_cast<std::size_t>(row * size + (x + size) % size)];
    };
    const double slope = size / (2.0 * metres);
    each_texel(size, [&](int x, int y, std::size_t i) {
        // Rows go down and the tangent space's y goes up, so the second slope is not negated.
        const glm::dvec3 n =
            glm::normalize(glm::dvec3(-slope * (height(x + 1, y) - height(x - 1, y)),
                                      slope * (height(x, y + 1) - height(x, y - 1)), 1.0));
        // 127.5 rounds up: 128 stands for 0 to within half a step.
        put(out, i, 0.5 * n + 0.5);
    });
    return out;
}

}  // namespace kilolux
