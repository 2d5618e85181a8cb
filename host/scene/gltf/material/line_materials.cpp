// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "host/scene/gltf/material/material.h"

namespace kilolux {
namespace {

// Base colour and emission are added where no texture or vertex colour multiplies only one.
void make_unlit(const GltfDocument& document, Material& material, bool colored) {
    set_unlit(material);
    const glm::vec3 emissive = material.emissive;
    if (std::max({emissive.x, emissive.y, emissive.z}) == 0.0f) return;
    if (colored || material.base_color_texture.present() || material.emissive_texture.present()) {
        document.leave_out(
            "the emission of points and lines with textures or vertex colours is "
            "left out");
    } else {
        material.base_color += glm::vec4(emissive, 0.0f);
    }
}

}  // namespace

LineMaterial line_material_of(const tinygltf::Primitive& primitive) {
    const auto& attributes = primitive.attributes;
    return {primitive.material, attributes.contains("NORMAL"), attributes.contains("TANGENT"),
            attributes.contains("COLOR_0")};
}

void add_line_materials(const GltfDocument& document, GltfMaterials& materials) {
    for (const tinygltf::Mesh& mesh : document.model.meshes) {
        for (const tinygltf::Primitive& primitive : mesh.primitives) {
            if (corners_of(primitive) == 3) continue;
            const LineMaterial key = line_material_of(primitive);
            const auto index = static_cast<std::size_t>(std::max(primitive.material, 0));
            const bool is_default = primitive.material == kDefaultMaterial;
            const bool bumpy = !is_default && materials.materials[index].normal_texture.present();
            const bool as_it_is = key.normals && (key.tangents || !bumpy);
            if (as_it_is || materials.of_lines.contains(key)) continue;
            Material made = is_default ? Material{} : materials.materials[index];
            made.normal_texture = {};
            if (!key.normals) make_unlit(document, made, key.colors);
            materials.of_lines[key] = static_cast<int>(materials.materials.size());
            materials.materials.push_back(std::move(made));
            materials.texcoord_sets.push_back(is_default ? std::array<int, 2>{0, 1}
                                                         : materials.texcoord_sets[index]);
        }
    }
}

}  // namespace kilolux
