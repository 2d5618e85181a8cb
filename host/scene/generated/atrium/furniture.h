// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/generated/mesh_builder.h"

namespace kilolux {

// Movable things, standing on y = 0 about the y axis unless said otherwise.

/// An urn, 0.95 m high.
MeshBuilder urn();
/// A bench 1.7 m long along x, seat towards -z.
MeshBuilder bench();
/// A round pot, 0.62 m high, with its soil.
MeshBuilder pot();
/// An orange tree's trunk and branches, from `bottom` up to 1.9 m.
MeshBuilder tree_trunk(double bottom);
/// Leaves in a ball of `radius` about (0, height, 0).
MeshBuilder foliage(double height, double radius, int leaves, std::uint64_t seed);
/// The iron of a hanging lantern: hung at (0, 0, 0), its cage `chain` below.
MeshBuilder lantern_iron(double chain);
/// Its panes.
MeshBuilder lantern_glass(double chain);
/// A banner that hangs from y = 0 down in the plane z = 0, to be seen from -z.
MeshBuilder banner();
/// The two halves of a curtain on a rod at y = 3.5 between two columns of a bay, tied back.
MeshBuilder curtain();
/// The curtain's rod and ties.
MeshBuilder curtain_rod();

}  // namespace kilolux
