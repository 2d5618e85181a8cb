// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace kilolux::atrium_plan {

// Dimensions [m]. The court's floor lies below the hall's, y = 0. Columns stand on a rectangle of
// 7 x 3 bays round the court; the aisle runs between them and the outer wall.
inline constexpr double kBay = 3.2;
inline constexpr double kHalfBay = kBay / 2;
inline constexpr int kLongBays = 7;
inline constexpr int kShortBays = 3;
inline constexpr double kHalfX = kLongBays * kHalfBay;  // column axes
inline constexpr double kHalfZ = kShortBays * kHalfBay;
inline constexpr double kAisle = 4.2;        // column axis to the outer wall's inner face
inline constexpr double kWallHalf = 0.35;    // half the thickness of the arcade's wall
inline constexpr double kStepsDepth = 1.45;  // column axis to the court's floor
inline constexpr double kCourtFloor = -0.45;
inline constexpr double kSpring = 3.6;  // where the arches of the arcade begin
inline constexpr double kArchRadius = 1.25;
inline constexpr double kVaultRise = 1.5;
inline constexpr double kArcadeTop = 5.4;  // of the arcade's wall; the cornice begins
inline constexpr double kGalleryFloor = 5.8;
inline constexpr double kUpperSpring = 8.3;
inline constexpr double kUpperRadius = 0.62;
inline constexpr double kUpperWallHalf = 0.2;
inline constexpr double kCeiling = 9.9;    // of the gallery; the eaves begin
inline constexpr double kEaves = 10.35;    // the roof's lower edge
inline constexpr double kRidge = 12.0;     // the roof's upper edge, on the outer wall
inline constexpr double kOuterFace = 4.7;  // column axis to the outer wall's outer face

/// Where a piece made in a bay's frame goes. The frame's origin is on the hall's floor, y = 0,
/// midway between two columns; x runs along the arcade, +z to the outer wall.
struct Place {
    glm::dmat4 world_from_piece{1.0};
    int side = 0;   // 0 south (+z), 1 east (+x), 2 north, 3 west
    int index = 0;  // along the side
};

/// The bays, side after side.
std::vector<Place> bays();

/// Whether a bay has an urn and a lantern; the bays between them have benches.
bool is_even(const Place& bay);

/// The four corners: origin at the corner column, +x and +z to the outer walls.
std::vector<Place> corners();

/// The four sides: origin between the corner columns, else like a bay.
std::vector<Place> sides();

/// Half the distance of the corner columns of a side.
double half_length(int side);

}  // namespace kilolux::atrium_plan
