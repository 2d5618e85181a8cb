// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/generated/procedural_mesh.h"

namespace kilolux {

// Floors and what stands in the court, in world space unless a frame is named.

/// The court's paving.
MeshBuilder court_paving();
/// The basin's rim and the fountain in its middle: pedestal, two bowls, finial.
MeshBuilder fountain_marble();
/// The basin's inner walls.
MeshBuilder basin_mosaic();
/// Water of the basin and of the bowls.
MeshBuilder fountain_water();

/// The patterned part of the aisle's floor and the gallery's floor, in a bay's frame.
MeshBuilder bay_tiles();
/// The bands at both sides of the aisle's floor, in a bay's frame.
MeshBuilder bay_floor_bands();

}  // namespace kilolux
