// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "host/scene/rows/material_row.h"
#include "host/scene/rows/surface_rows.h"

namespace kilolux {

/// The textures that a scene's surfaces read, and the places of their texels. An image that some
/// slot reads as sRGB and another as linear is stored twice; textures of one image share its
/// texels.
class TextureTable {
 public:
    /// Takes the textures that `features` read. Throws Error when one image or all together are too
    /// large.
    TextureTable(const Scene& scene, const MeshFeatures& features);

    std::span<const TextureRow> rows() const { return rows_; }

    /// The row that a material's slot USE_* reads, or SURFACE_ABSENT.
    uint number_of(const Material& material, int use) const;

    /// Texels of all images with their mip levels.
    std::size_t texels() const { return texels_; }

    using Encoded = std::pair<int, bool>;  // a texture or image, and whether it is sRGB

    /// The images, with the place of each one's first texel.
    const std::map<Encoded, std::size_t>& images() const { return first_texel_; }

 private:
    void add(int texture, bool srgb);
    std::size_t place_image(int image, bool srgb);

    const Scene& scene_;
    std::vector<TextureRow> rows_;
    std::map<Encoded, uint> numbers_;             // of textures
    std::map<Encoded, std::size_t> first_texel_;  // of images
    std::size_t texels_ = 0;
};

}  // namespace kilolux
