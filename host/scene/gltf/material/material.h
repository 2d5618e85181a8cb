// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>

#include "host/scene/gltf/mesh/mesh.h"

namespace kilolux {

/// An image to be made: green is 1 - glossiness * the alpha of another one.
struct RoughnessImage {
    int image = 0;  // index into GltfMaterials::images
    double glossiness = 1.0;
    bool operator==(const RoughnessImage&) const = default;
};

/// Properties of points and lines that decide their material.
struct LineMaterial {
    int material = kDefaultMaterial;
    bool normals = false;
    bool tangents = false;
    bool colors = false;
    auto operator<=>(const LineMaterial&) const = default;
};

/// A file's materials, and what they use of its textures and images.
struct GltfMaterials {
    std::vector<Material> materials;                // the file's, then those of `of_lines`
    std::vector<std::array<int, 2>> texcoord_sets;  // per material: the file's sets that it uses
    std::vector<Texture> textures;                  // images index `images`, then `roughness`
    std::vector<int> images;                        // indices into the file's images
    std::vector<RoughnessImage> roughness;          // of specular-glossiness materials
    std::map<LineMaterial, int> of_lines;           // materials made for points and lines
    std::set<std::size_t> stretched;                // of the file's: anisotropic at some time
};

/// Converts all materials. Factors are clamped to the ranges that the specification gives them.
GltfMaterials convert_materials(const GltfDocument& document);

/// Makes a material show its base colour alone, without reflections.
void set_unlit(Material& material);

/// Attributes of its mesh that a primitive needs.
MeshShading shading_of(const GltfMaterials& materials, const tinygltf::Primitive& primitive);

/// The key of the material of a primitive of points or lines.
LineMaterial line_material_of(const tinygltf::Primitive& primitive);

/// Adds the materials that the file's points and lines need beside its own (glTF 2.0,
/// section 3.9.7): unlit without normals, their colour being base colour and emission together;
/// without normal maps and anisotropy where there are no tangents.
void add_line_materials(const GltfDocument& document, GltfMaterials& materials);

}  // namespace kilolux
