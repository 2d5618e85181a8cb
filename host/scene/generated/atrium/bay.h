// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/generated/mesh_builder.h"

namespace kilolux {

// One bay, in the bay's frame (plan.h).

/// The arcade's wall above the columns: faces to court and aisle.
MeshBuilder arcade_wall();
/// Its dressed arch stones, both faces and soffit.
MeshBuilder arcade_voussoirs();
/// Label mouldings of the arch and a medallion in the spandrels.
MeshBuilder arcade_mouldings();
/// The ground floor's outer wall with a blind niche.
MeshBuilder aisle_wall();
/// The niche's back wall and sill.
MeshBuilder aisle_plaster();
/// Pilaster, base, string course and arch of the niche.
MeshBuilder aisle_mouldings();
/// The pilaster that carries a rib, at x on the outer wall.
void add_pilaster(MeshBuilder& builder, double x);
/// The gallery's wall above its columns, towards court and gallery.
MeshBuilder gallery_arches();
/// Arch bands of the gallery.
MeshBuilder gallery_stones();
/// The gallery's outer wall with a window recess.
MeshBuilder gallery_wall();
/// The shutters of the window and the coffered ceiling.
MeshBuilder gallery_wood();

}  // namespace kilolux
