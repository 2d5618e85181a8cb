// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>

#include "host/scene/gltf/document.h"

namespace kilolux {

/// A material's use of a texture as the file gives it.
struct FileTextureUse {
    int texture = -1;
    int texcoord = 0;
    const tinygltf::ExtensionMap* extensions = nullptr;
};

/// Collects the textures and images that materials use, each once.
class TextureTable {
 public:
    explicit TextureTable(const GltfDocument& document) : document_(document) {}

    /// The use, with its TEXCOORD_n as uv_set. Not present when the file names no texture, or the
    /// texture has no image that can be read (warned of once).
    TextureUse convert(const FileTextureUse& use);

    const std::vector<Texture>& textures() const { return textures_; }
    const std::vector<int>& images() const { return images_; }

 private:
    const GltfDocument& document_;
    std::vector<Texture> textures_;
    std::vector<int> images_;
    std::map<int, int> texture_of_;  // by the file's texture
    std::map<int, int> image_of_;    // by the file's image
};

}  // namespace kilolux
