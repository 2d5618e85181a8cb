// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>

#include "host/scene/gltf/mesh/mesh.h"

namespace kilolux {

/// A file's materials, and what they use of its textures and images.
struct GltfMaterials {
    std::vector<Material> materials;                // as in the file
    std::vector<std::array<int, 2>> texcoord_sets;  // per material: the file's sets that it uses
    std::vector<Texture> textures;                  // images index `images`
    std::vector<int> images;                        // indices into the file's images
};

/// Converts all materials. Factors are clamped to the ranges that the specification gives them.
GltfMaterials convert_materials(const GltfDocument& document);

/// What a primitive of the material (-1: none) needs of its mesh.
MeshShading shading_of(const GltfMaterials& materials, int material);

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
