// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/generated/procedural_mesh.h"

namespace kilolux {

// Pieces that run along a whole side of the court, in the side's frame (atrium_plan.h), mitred at
// the corners. `half` [m]: half the distance of its corner columns.

/// Cornices of both storeys with dentils, towards the court.
MeshBuilder side_cornices(double half);
/// The steps from the hall down to the court, and the paving of the arcade's line.
MeshBuilder side_steps(double half);
/// The roof's tiles and one hip.
MeshBuilder side_roof(double half);
/// Rafters and boards below the eaves.
MeshBuilder side_eaves(double half);
/// The outer face of the outer wall.
MeshBuilder side_outer_wall(double half);

/// Rails and balusters of one bay of the gallery, in the bay's frame.
MeshBuilder balustrade();

}  // namespace kilolux
