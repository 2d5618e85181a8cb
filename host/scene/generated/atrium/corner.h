// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/generated/procedural_mesh.h"

namespace kilolux {

// Pieces of the hall's corners in the corner's frame (atrium_plan.h): x and z in 0..kAisle. Two
// corners have a groin vault, the other two a winding stair to the gallery.

MeshBuilder corner_brick();
MeshBuilder corner_mouldings();
MeshBuilder corner_floor_bands();
MeshBuilder corner_wood();
/// Plaster, and tiles of both floors, of a corner with a vault or with a stair.
MeshBuilder corner_plaster(bool with_stair);
MeshBuilder corner_tiles(bool with_stair);

/// The winding stair: newel and steps.
MeshBuilder stair_stones();
/// Its handrail, and the railing round the opening in the gallery's floor.
MeshBuilder stair_rails();

}  // namespace kilolux
