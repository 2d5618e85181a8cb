// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/generated/mesh_builder.h"

namespace kilolux {

// Columns, about the y axis.

/// The arcade's column from y = 0 to the spring line: fluted shaft with entasis.
MeshBuilder column_shaft();
/// Its plinth, Attic base, capital with two rows of leaves and corner volutes, and abacus.
MeshBuilder column_stones();
/// The gallery's slender column, from the gallery's floor to its spring line.
MeshBuilder gallery_column();

}  // namespace kilolux
