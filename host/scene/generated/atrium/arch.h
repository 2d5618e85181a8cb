// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "host/scene/generated/mesh_builder.h"

namespace kilolux {

/// A wall panel in a plane of constant z with a round-headed opening in its middle [m].
struct ArchPanel {
    double center = 0.0;      // x
    double half_width = 1.6;  // of the panel
    double bottom = 0.0;      // y; the opening begins there
    double top = 5.4;         // y
    double radius_x = 1.25;   // of the opening
    double radius_y = 1.25;
    double spring = 3.6;  // y at which the arch begins
    int segments = 24;
};

/// The panel's face at z, to +z or -z.
void add_arch_face(MeshBuilder& builder, const ArchPanel& panel, double z, bool to_plus_z);

/// The reveal of the opening between two z: the arch's soffit and the jambs below it.
void add_arch_reveal(MeshBuilder& builder, const ArchPanel& panel, double z0, double z1);

/// Frames along the opening's half ellipse from +x to -x: profile x goes outwards from it, profile
/// y along z when `to_plus_z`, else against it. `around` [m] is the length in u.
std::vector<SweepFrame> arch_frames(const ArchPanel& panel, double z, bool to_plus_z,
                                    double around);

/// The half of an arch's dressed stones at one face of a wall of half thickness `wall_half` about
/// z = 0: soffit to the middle, and a ring of width `ring` that stands out from the face by 3 cm.
void add_voussoirs(MeshBuilder& builder, const ArchPanel& panel, double wall_half, double ring,
                   bool to_plus_z);

/// A label moulding round an arch at a distance `ring` outside its opening.
void add_label(MeshBuilder& builder, const ArchPanel& panel, double z, double ring, bool to_plus_z);

/// A groin vault over a rectangle of half extents `half` about (center.x, center.y) in x and z,
/// from the spring line up by the vault's rise: two elliptic barrels that cross.
void add_groin_vault(MeshBuilder& builder, glm::dvec2 center, glm::dvec2 half);

/// The arch that spans the aisle from the column at the origin to the outer wall, below the vault.
void add_rib(MeshBuilder& builder);

/// A coffered ceiling of cells_x by cells_z square-ish coffers over [low, high] in x and z, its
/// beams' lower faces at height y.
void add_coffers(MeshBuilder& builder, glm::dvec2 low, glm::dvec2 high, glm::ivec2 cells, double y);

}  // namespace kilolux
