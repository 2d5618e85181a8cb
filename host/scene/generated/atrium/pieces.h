// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "host/scene/generated/mesh_builder.h"

// The pieces that the atrium is built from, one builder per piece and material.
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
/// The patterned part of the aisle's floor, and the gallery's floor.
MeshBuilder bay_tiles();
/// The bands at both sides of the aisle's floor.
MeshBuilder bay_floor_bands();
/// The gallery's wall above its columns, towards court and gallery.
MeshBuilder gallery_arches();
/// Arch bands of the gallery.
MeshBuilder gallery_stones();
/// The gallery's outer wall with a window recess.
MeshBuilder gallery_wall();
/// The shutters of the window and the coffered ceiling.
MeshBuilder gallery_wood();
/// Rails and balusters of the gallery.
MeshBuilder balustrade();

// Columns, about the y axis.

/// The arcade's column from y = 0 to the spring line: fluted shaft with entasis.
MeshBuilder column_shaft();
/// Its plinth, Attic base, capital with two rows of leaves and corner volutes, and abacus.
MeshBuilder column_stones();
/// The gallery's slender column, from the gallery's floor to its spring line.
MeshBuilder gallery_column();

// The hall's corners in the corner's frame (plan.h): x and z in 0..kAisle. Two corners have a groin
// vault, the other two a winding stair to the gallery.

MeshBuilder corner_brick();
MeshBuilder corner_mouldings();
MeshBuilder corner_floor_bands();
MeshBuilder corner_wood();
MeshBuilder corner_plaster(bool with_stair);
/// Tiles of both floors.
MeshBuilder corner_tiles(bool with_stair);
/// The winding stair: newel and steps.
MeshBuilder stair_stones();
/// Its handrail, and the railing round the opening in the gallery's floor.
MeshBuilder stair_rails();

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

// The court, in world space.

MeshBuilder court_paving();
/// The basin's rim and the fountain in its middle: pedestal, two bowls, finial.
MeshBuilder fountain_marble();
/// The basin's inner walls.
MeshBuilder basin_mosaic();
/// Water of the basin and of the bowls.
MeshBuilder fountain_water();

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
