// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/gltf/material/material.h"

namespace kilolux {

/// A point of a metallic-roughness material's surface; linear.
struct MetallicRoughness {
    glm::dvec3 base_color{1.0};
    double metallic = 1.0;
    double roughness = 1.0;
};

/// The metallic-roughness point for a specular-glossiness one, by the conversion in the appendix of
/// KHR_materials_pbrSpecularGlossiness: the metallic value for which one grey base colour gives
/// both reflectances,
///   diffuse (1 - max(specular)) = base (1 - 0.04) (1 - metallic)
///   specular = 0.04 (1 - metallic) + base metallic,
/// solved for the colours' perceived brightness.
///
/// Exact for grey materials of a specular colour of at least 0.04; below, F0 becomes 0.04. In
/// coloured ones a single metallic value serves three channels:
/// tests/scene/specular_glossiness_test.cpp bounds what that costs.
MetallicRoughness metallic_roughness_of(const SpecularGlossiness& from);

/// Whether a material has the extension, which then wins over its pbrMetallicRoughness (the
/// extension's section "Best practices").
bool is_specular_glossiness(const nlohmann::json& material);

/// Sets base colour, metallic and roughness of the materials that have the extension. Their
/// textures become GltfMaterials::converted.
void convert_specular_glossiness(const GltfDocument& document, GltfMaterials& materials);

/// The images of GltfMaterials::converted, two each.
std::vector<Image> make_converted_images(const GltfDocument& document,
                                         const GltfMaterials& materials);

}  // namespace kilolux
