// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/generated/mesh_builder.h"

namespace kilolux {

/// Rails and balusters of the gallery.
MeshBuilder balustrade();

// What runs along a whole side of the court, in the side's frame (plan.h), mitred at the corners.
// `half` [m]: half the distance of its corner columns.

/// Cornices of both storeys with dentils, towards the court.
MeshBuilder side_cornices(double half);
/// The steps from the hall down to the court.
MeshBuilder side_steps(double half);
/// The roof's tiles and one hip.
MeshBuilder side_roof(double half);
/// Rafters and boards below the eaves.
MeshBuilder side_eaves(double half);
/// The outer face of the outer wall.
MeshBuilder side_outer_wall(double half);

/// The winding stair: newel and steps.
MeshBuilder stair_stones();
/// Its handrail, and the railing round the opening in the gallery's floor.
MeshBuilder stair_rails();

}  // namespace kilolux
