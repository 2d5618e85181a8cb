// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "host/gpu/features.h"
#include "host/scene/material_row.h"
#include "host/stages/surfaces/resolve_surfaces.h"

namespace kilolux {

/// The textures that a scene's surfaces read, and where their texels go. An image that some slot
/// reads as sRGB and another as linear is there twice; textures of one image share its texels.
class TextureTable {
 public:
    /// Throws Error when an image is too large, or all are.
    TextureTable(const Scene& scene, const SurfaceFeatures& features);

    std::span<const TextureRow> rows() const { return rows_; }

    /// The row that a material's slot USE_* reads, or SURFACE_ABSENT.
    uint number_of(const Material& material, int use) const;

    /// Texels of all images with their mip levels.
    std::size_t texels() const { return texels_; }

    /// Makes all of them on the device.
    void upload(const Gpu& gpu, const Tuning& tuning,
                const DeviceArray<std::uint64_t>& texels) const;

 private:
    using Encoded = std::pair<int, bool>;  // a texture or image, and whether it is sRGB
    void add(int texture, bool srgb);
    std::size_t place_image(int image, bool srgb);

    const Scene& scene_;
    uint uses_;
    std::vector<TextureRow> rows_;
    std::map<Encoded, uint> numbers_;             // of textures
    std::map<Encoded, std::size_t> first_texel_;  // of images
    std::size_t texels_ = 0;
};

}  // namespace kilolux
