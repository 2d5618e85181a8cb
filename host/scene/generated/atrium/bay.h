// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/generated/procedural_mesh.h"

namespace kilolux {

// Pieces of one bay in the bay's frame (atrium_plan.h), one builder a material.

/// The arcade's wall above the columns: faces to court and aisle, to be plastered.
MeshBuilder arcade_wall();
/// Its dressed arch stones, both faces and soffit.
MeshBuilder arcade_voussoirs();
/// Label mouldings of the arch, half of the ribs' imposts, medallions in the spandrels.
MeshBuilder arcade_mouldings();

/// The ground floor's outer wall with a blind niche, of brick.
MeshBuilder aisle_wall();
/// The niche's back and its frieze, to be plastered.
MeshBuilder aisle_plaster();
/// Pilaster, base, string course and arch of the niche.
MeshBuilder aisle_mouldings();

/// The gallery's wall above its columns, towards court and gallery, of brick.
MeshBuilder gallery_arches();
/// Arch bands and rail of the gallery: balusters stand on the bay's edge to the court.
MeshBuilder gallery_stones();
/// The gallery's outer wall with a window recess, plastered.
MeshBuilder gallery_wall();
/// The shutters of the window and the coffered ceiling.
MeshBuilder gallery_wood();

}  // namespace kilolux
