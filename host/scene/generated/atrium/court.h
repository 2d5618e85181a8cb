// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/generated/mesh_builder.h"

namespace kilolux {

/// The patterned part of the aisle's floor, and the gallery's floor.
MeshBuilder bay_tiles();
/// The bands at both sides of the aisle's floor.
MeshBuilder bay_floor_bands();

// The court, in world space.

MeshBuilder court_paving();
/// The basin's rim and the fountain in its middle: pedestal, two bowls, finial.
MeshBuilder fountain_marble();
/// The basin's inner walls.
MeshBuilder basin_mosaic();
/// Water of the basin and of the bowls.
MeshBuilder fountain_water();

// The hall's corners in the corner's frame (plan.h): x and z in 0..kAisle. Two corners have a groin
// vault, the other two a winding stair to the gallery.

MeshBuilder corner_brick();
MeshBuilder corner_mouldings();
MeshBuilder corner_floor_bands();
MeshBuilder corner_wood();
MeshBuilder corner_plaster(bool with_stair);
/// Tiles of both floors.
MeshBuilder corner_tiles(bool with_stair);

}  // namespace kilolux
