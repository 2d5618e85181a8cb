// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "host/scene/generated/procedural_mesh.h"
#include "host/scene/scene.h"

namespace kilolux {

/// The atrium's materials, in the order in which they stand in Scene::materials.
enum class AtriumMaterial {
    marble,
    limestone,
    brick,
    plaster,
    tile,
    paving,
    voussoir,
    wood,
    terracotta,
    mosaic,
    water,
    leaf,
    iron,
    glass,
    cloth_red,
    cloth_blue,
    cloth_gold,
    count
};

/// Appends the atrium's images, textures and materials to an empty scene. Dielectric throughout and
/// without emission, so that the G-buffer needs no fourth plane. Images are made on all cores.
void add_atrium_materials(Scene& scene, std::uint64_t seed);

/// The mesh of `builder` with the material's texture density and, where it has a normal map,
/// tangents.
Mesh atrium_mesh(std::string name, const MeshBuilder& builder, AtriumMaterial material);

}  // namespace kilolux
