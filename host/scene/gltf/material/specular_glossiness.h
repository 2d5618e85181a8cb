// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/gltf/material/material.h"
#include "host/scene/gltf/material/texture.h"

namespace kilolux {

/// Whether a material has KHR_materials_pbrSpecularGlossiness, which then wins over its
/// pbrMetallicRoughness (the extension's section "Best practices").
bool is_specular_glossiness(const nlohmann::json& material);

/// Sets a material by the extension: without metal, with an ior of 0, which leaves reflectance to
/// the specular colour (KHR_materials_ior), and with both textures as they are. Roughness is
/// 1 - glossiness, whose texture add_roughness_textures() makes.
void read_specular_glossiness(Material& out, const nlohmann::json& source, FileTextures& textures);

/// Gives such materials a texture of roughness: GltfMaterials::roughness.
void add_roughness_textures(const GltfDocument& document, GltfMaterials& materials);

/// The images of GltfMaterials::roughness, from those of GltfMaterials::images.
std::vector<Image> roughness_images(const GltfDocument& document, const GltfMaterials& materials,
                                    std::span<const Image> images);

}  // namespace kilolux
