// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/gltf/mesh/mesh.h"
#include "host/scene/gltf/nodes.h"

namespace kilolux {

/// A skin at its joints' present places.
struct PlacedSkin {
    glm::dmat4 world_from_object{1.0};         // where the skinned mesh's own space is put
    std::vector<glm::dmat4> object_from_bind;  // one per joint
};

/// The skin's joint matrices, relative to the first joint's position so that baked vertices stay
/// precise far from the origin.
PlacedSkin place_skin(const GltfDocument& document, std::size_t skin, const PlacedNodes& nodes);

/// Moves a mesh's positions, normals and tangents by its joints; `elements` gives each vertex's
/// element in the arrays. All sets JOINTS_n and WEIGHTS_n count, weights are made to sum to 1.
void skin_mesh(Mesh& mesh, const PrimitiveArrays& arrays, std::span<const std::uint32_t> elements,
               std::span<const glm::dmat4> object_from_bind);

}  // namespace kilolux
