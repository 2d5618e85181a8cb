// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "host/scene/scene.h"
#include "raster/gl_object.h"

namespace kilolux {

/// A scene's images and samplers in the current context. An image that some slot reads as sRGB and
/// another as linear exists twice, so that each has mipmaps averaged in light.
class GpuTextures {
 public:
    /// `anisotropy`: at most this many samples along a texture's longer footprint; 1 for none.
    GpuTextures(const Scene& scene, float anisotropy);

    /// Uploads the textures of a material that `features` reads and that are not there.
    void upload(const Scene& scene, const Material& material, uint features);

    /// Binds what a material's slot USE_* reads to the texture unit of that slot.
    void bind(const Scene& scene, const TextureUse& use, int slot) const;

    std::size_t texture_count() const { return textures_.size(); }

 private:
    std::map<std::pair<int, bool>, GlTexture> textures_;  // by image and whether it is sRGB
    std::vector<GlSampler> samplers_;                     // one per Scene::textures
};

}  // namespace kilolux
