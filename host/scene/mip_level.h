// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "host/scene/scene.h"

namespace kilolux {

enum class TextureEncoding { linear, srgb };

/// A mip level of an image, decoded to linear values.
struct MipLevel {
    int width = 0;
    int height = 0;
    const Image* image = nullptr;  // of level 0
    TextureEncoding encoding = TextureEncoding::linear;
    std::vector<glm::vec4> texels{};  // of the other levels

    glm::dvec4 texel(int x, int y) const;
};

/// RGBA at the coordinates, as OpenGL 4.5 (8.14) filters and wraps, in double.
glm::dvec4 filtered(Filter filter, const MipLevel& level, const Sampler& sampler,
                    const glm::dvec2& uv);

}  // namespace kilolux
