// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/generated/procedural_mesh.h"

namespace kilolux {

/// A groin vault over a rectangle of half extents `half` about (center.x, center.y) in x and z,
/// from the spring line up by the vault's rise: two elliptic barrels that cross.
void add_groin_vault(MeshBuilder& builder, glm::dvec2 center, glm::dvec2 half);

/// The arch that spans the aisle from the column at the origin to the outer wall, below the vault.
void add_rib(MeshBuilder& builder);

/// A coffered ceiling of cells_x by cells_z square-ish coffers over [low, high] in x and z, its
/// beams' lower faces at height y.
void add_coffers(MeshBuilder& builder, glm::dvec2 low, glm::dvec2 high, glm::ivec2 cells, double y);

}  // namespace kilolux
