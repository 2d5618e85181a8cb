// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "host/scene/generated/mesh_builder.h"
#include "host/scene/scene.h"

namespace kilolux {

/// The atrium's materials, in the order of Scene::materials.
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

/// Appends the atrium's images, textures and materials to an empty scene. All are dielectric and
/// without emission, so that the G-buffer needs no fourth plane. Runs on all cores.
void add_atrium_materials(Scene& scene, std::uint64_t seed);

/// Appends the mesh of `builder` with the material's texture density and, where it has a normal
/// map, tangents; returns its index.
int add_atrium_mesh(Scene& scene, const char* name, const MeshBuilder& builder,
                    AtriumMaterial material);

}  // namespace kilolux
