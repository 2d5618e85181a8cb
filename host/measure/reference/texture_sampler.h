// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "host/scene/mip_level.h"

namespace kilolux {

/// Texture coordinates and their change from a pixel to its right and lower neighbour.
struct TextureFootprint {
    glm::dvec2 uv{0.0};
    glm::dvec2 uv_dx{0.0};  // per pixel to the right
    glm::dvec2 uv_dy{0.0};  // per pixel down
};

/// Reads a scene's textures as OpenGL 4.5 does (8.14), in double, without its approximations.
///
/// The mip level is log2 of the longer side of the pixel's footprint in texels, without anisotropy;
/// levels up to 0 use the magnifying filter. A mip level averages the level before it: 2x2 texels,
/// or for odd sizes the linear filter's value at the new texel's centre. sRGB is decoded before any
/// filter. Level 0 is exact, the others are kept in float32 (relative 6e-8).
class TextureSampler {
 public:
    /// Prepares the mip levels of every texture that a material of the scene uses. Keeps a
    /// reference to the scene.
    explicit TextureSampler(const Scene& scene);

    /// RGBA at the footprint; (1, 1, 1, 1) for a use without a texture.
    glm::dvec4 sample(const TextureUse& use, TextureEncoding encoding,
                      const std::array<TextureFootprint, 2>& uv_sets) const;

 private:
    void prepare(const TextureUse& use, TextureEncoding encoding);

    const Scene& scene_;
    std::array<std::vector<std::vector<MipLevel>>, 2> levels_;  // by encoding, by image
};

}  // namespace kilolux
