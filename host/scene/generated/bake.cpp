// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/bake.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace kilolux {
namespace {

std::uint8_t to_byte(double x) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(x, 0.0, 1.0) * 255.0));
}

Image empty_image(const std::string& name, int size) { return {name, size, size, {}}; }

void push(Image& image, const glm::dvec3& c) {
    image.rgba.insert(image.rgba.end(), {to_byte(c.x), to_byte(c.y), to_byte(c.z), 255});
}

}  // namespace

SurfaceImages bake(const BakeOptions& options, const std::function<Texel(double, double)>& texel) {
    SurfaceImages out;
    out.name = options.name;
    out.base_color = empty_image(options.name + "-base-color", options.size);
    out.roughness = empty_image(options.name + "-roughness", options.size);
    std::vector<float> heights;
    for (int y = 0; y < options.size; ++y) {
        for (int x = 0; x < options.size; ++x) {
            const Texel t = texel((x + 0.5) / options.size, (y + 0.5) / options.size);
            if (options.base_color) push(out.base_color, t.color);
            if (options.roughness) push(out.roughness, {1.0, t.roughness, 0.0});
            if (options.normal) heights.push_back(static_cast<float>(t.height));
        }
    }
    if (options.normal) {
        out.normal = normal_map(options.name + "-normal", heights, options.size, options.metres);
    }
    return out;
}

Image normal_map(const std::string& name, const std::vector<float>& heights, int size,
                 double metres) {
    Image out = empty_image(name, size);
    const auto height = [&](int x, int y) {
        const int row = (y + size) % size;
        return heights[static_cast<std::size_t>(row * size + (x + size) % size)];
    };
    const double slope = size / (2.0 * metres);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            // Rows go down and the tangent space's y goes up, so the second slope is not negated.
            const glm::dvec3 n =
                glm::normalize(glm::dvec3(-slope * (height(x + 1, y) - height(x - 1, y)),
                                          slope * (height(x, y + 1) - height(x, y - 1)), 1.0));
            // 127.5 rounds up: 128 stands for 0 to within half a step.
            push(out, 0.5 * n + 0.5);
        }
    }
    return out;
}

}  // namespace kilolux
