// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/gltf/mesh/mesh.h"

namespace kilolux {

/// Collects the textures and images that materials use, each once.
class FileTextures {
 public:
    explicit FileTextures(const GltfDocument& document) : document_(document) {}

    /// The use at a path of a material ("pbrMetallicRoughness.baseColorTexture"), with its
    /// TEXCOORD_n as uv_set. Not present when the file names no texture there, or the texture has
    /// no image that can be read (warned of once).
    TextureUse convert(const nlohmann::json& material, std::string_view path);

    const std::vector<Texture>& textures() const { return textures_; }
    const std::vector<int>& images() const { return images_; }

 private:
    // The texture's place in textures(), where it is added first; -1 where it has no image.
    int place(int texture);

    const GltfDocument& document_;
    std::vector<Texture> textures_;
    std::vector<int> images_;
    std::map<int, int> texture_of_;  // by the file's texture
    std::map<int, int> image_of_;    // by the file's image
};

}  // namespace kilolux
