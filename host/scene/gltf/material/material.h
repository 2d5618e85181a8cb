// SPDX-License-Identifier: Apache-2.0
#pragma once

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

}  // namespace kilolux
