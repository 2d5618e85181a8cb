// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/atrium/court.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/scene/generated/atrium/arch.h"
#include "host/scene/generated/atrium/bay.h"
#include "host/scene/generated/atrium/plan.h"

namespace kilolux {
namespace {

using namespace atrium_plan;

constexpr glm::dvec2 kBasin(3.0, 1.25);  // half extents of the water [m]
constexpr double kWater = kCourtFloor + 0.36;

// A profile round the basin; its x goes outwards from the water's edge.
void add_round_basin(MeshBuilder& builder, const Profile& profile) {
    const glm::dvec2 h = kBasin;
    const glm::dvec3 corners[4] = {{-h.x, 0, h.y}, {h.x, 0, h.y}, {h.x, 0, -h.y}, {-h.x, 0, -h.y}};
    const glm::dvec3 outs[4] = {{0, 0, 1}, {1, 0, 0}, {0, 0, -1}, {-1, 0, 0}};
    for (int i = 0; i < 4; ++i) {
        builder.sweep(profile, straight_frames(corners[i], corners[(i + 1) % 4], outs[i], 1.0));
    }
}

// Pedestal and two bowls, one above the other, with a finial.
void add_fountain(MeshBuilder& builder) {
    const double f = kCourtFloor;
    builder.lathe(
        {{Point2(0.42, f), Point2(0.42, f + 0.45), Point2(0.36, f + 0.50), Point2(0.20, f + 0.60),
          Point2(0.14, f + 0.85), Point2(0.17, f + 1.05), Point2(0.30, f + 1.14),
          Point2(0.72, f + 1.24), Point2(0.92, f + 1.38), Point2(0.96, f + 1.46),
          Point2(0.92, f + 1.48), Point2(0.86, f + 1.44), Point2(0.70, f + 1.34)},
         0.8},
        40);
    builder.lathe({{Point2(0.11, f + 1.30), Point2(0.12, f + 1.50), Point2(0.08, f + 1.60),
                    Point2(0.09, f + 1.90), Point2(0.16, f + 1.98), Point2(0.40, f + 2.06),
                    Point2(0.50, f + 2.16), Point2(0.50, f + 2.20), Point2(0.46, f + 2.19),
                    Point2(0.36, f + 2.12)},
                   0.8},
                  32);
    builder.lathe({{Point2(0.07, f + 2.10), Point2(0.05, f + 2.28), Point2(0.09, f + 2.34),
                    Point2(0.13, f + 2.44), Point2(0.12, f + 2.54), Point2(0.06, f + 2.64),
                    Point2(0.02, f + 2.74), Point2(0.0, f + 2.78)},
                   0.9},
                  20);
}

using namespace atrium_plan;

constexpr double kMiddle = kAisle / 2;
constexpr double kStairWell = 1.75;     // radius of the opening [m]
constexpr double kStairCeiling = 5.55;  // of the ground floor round the opening

// A piece at the wall z = kAisle, and again at the wall x = kAisle.
void add_at_both_walls(MeshBuilder& builder, const MeshBuilder& piece) {
    builder.append(piece);
    // Swaps x and z: a reflection; append() corrects the winding.
    glm::dmat4 swap(0.0);
    swap[0][2] = swap[2][0] = swap[1][1] = swap[3][3] = 1.0;
    builder.append(piece, swap);
}

// A floor or ceiling over the corner with a round hole, at height y.
void add_square_with_hole(MeshBuilder& builder, double y, bool up) {
    constexpr int kSegments = 48;
    builder.patch(kSegments, 1, [&](double u, double v) {
        const double angle = 2.0 * std::numbers::pi * u;
        const glm::dvec2 out(std::cos(angle), std::sin(angle));
        const double to_square = kMiddle / std::max(std::abs(out.x), std::abs(out.y));
        const glm::dvec2 p = kMiddle + out * (v < 0.5 ? kStairWell : to_square);
        return SurfacePoint{{p.x, y, p.y}, {0, up ? 1 : -1, 0}, p};
    });
}

void add_stair_shaft(MeshBuilder& builder) {
    const ArchPanel panel{.center = kMiddle,
                          .half_width = kMiddle,
                          .bottom = kSpring,
                          .top = kStairCeiling,
                          .radius_x = kMiddle,
                          .radius_y = kVaultRise,
                          .spring = kSpring,
                          .segments = 24};
    MeshBuilder face;
    add_arch_face(face, panel, 0.0, true);
    add_at_both_walls(builder, face);
    add_square_with_hole(builder, kStairCeiling, false);
    const Profile rim{{{kStairWell, kGalleryFloor}, {kStairWell, kStairCeiling}}, 0.3};
    builder.lathe(rim, 48, {kMiddle, 0.0, kMiddle});
}

}  // namespace

MeshBuilder court_paving() {
    MeshBuilder builder;
    const double x = kHalfX - kStepsDepth;
    const double z = kHalfZ - kStepsDepth;
    // Around the basin: nothing is drawn below the water.
    builder.level({-x, -z}, {-kBasin.x, z}, kCourtFloor);
    builder.level({kBasin.x, -z}, {x, z}, kCourtFloor);
    builder.level({-kBasin.x, -z}, {kBasin.x, -kBasin.y}, kCourtFloor);
    builder.level({-kBasin.x, kBasin.y}, {kBasin.x, z}, kCourtFloor);
    return builder;
}

MeshBuilder fountain_marble() {
    MeshBuilder builder;
    const double f = kCourtFloor;
    add_round_basin(builder,
                    {{Point2(0.42, f), Point2(0.42, f + 0.10), Point2(0.36, f + 0.14),
                      Point2(0.33, f + 0.34), Point2(0.36, f + 0.40), Point2(0.42, f + 0.44),
                      Point2(0.43, f + 0.50), Point2(0.40, f + 0.53), Point2(0.02, f + 0.53),
                      Point2(-0.02, f + 0.50), Point2(-0.02, f + 0.44), Point2(0.0, f + 0.43)},
                     0.6});
    add_fountain(builder);
    return builder;
}

MeshBuilder basin_mosaic() {
    MeshBuilder builder;
    add_round_basin(builder, {{{0.0, kCourtFloor + 0.43}, {0.0, kCourtFloor - 0.05}}, 0.5});
    return builder;
}

MeshBuilder fountain_water() {
    MeshBuilder builder;
    builder.level(-kBasin, kBasin, kWater);
    for (const glm::dvec2& bowl : {glm::dvec2(0.88, 1.44), glm::dvec2(0.47, 2.18)}) {
        const glm::dvec3 center(0.0, kCourtFloor + bowl.y, 0.0);
        const std::vector<SweepFrame> frames =
            round_frames(center, 32, 0.0, 6.283185307179586, 1.0);
        builder.patch(32, 1, [&](double u, double v) {
            const SweepFrame& f = frames[static_cast<std::size_t>(std::lround(u * 32))];
            const glm::dvec3 p = center + (v * bowl.x) * f.axis_x;
            return SurfacePoint{p, {0, 1, 0}, {p.x, p.z}};
        });
    }
    return builder;
}

MeshBuilder bay_tiles() {
    MeshBuilder builder;
    builder.level({-kHalfBay, 0.7}, {kHalfBay, 3.9}, 0);
    builder.level({-kHalfBay, 0}, {kHalfBay, kAisle}, kGalleryFloor);
    return builder;
}

MeshBuilder bay_floor_bands() {
    MeshBuilder builder;
    builder.level({-kHalfBay, 0}, {kHalfBay, 0.7}, 0);
    builder.level({-kHalfBay, 3.9}, {kHalfBay, kAisle}, 0);
    return builder;
}

MeshBuilder corner_brick() {
    MeshBuilder wall;
    wall.wall({0, 0}, {kAisle, kGalleryFloor}, kAisle, -1);
    // The block of the gallery's wall over the corner column.
    wall.wall({0, kUpperSpring}, {kUpperWallHalf, kCeiling}, kUpperWallHalf, 1);
    MeshBuilder builder;
    add_at_both_walls(builder, wall);
    return builder;
}

MeshBuilder corner_mouldings() {
    MeshBuilder wall;
    wall.sweep({{{0.06, 0.0}, {0.06, 0.16}, {0.03, 0.20}, {0.0, 0.21}}, 0.5},
               straight_frames({kAisle, 0, kAisle}, {0, 0, kAisle}, {0, 0, -1}));
    MeshBuilder builder;
    add_at_both_walls(builder, wall);
    add_pilaster(builder, 0.0);  // at the far end of the side's last bay
    return builder;
}

MeshBuilder corner_floor_bands() {
    MeshBuilder builder;
    builder.level({0, 0}, {kAisle, 0.7}, 0);
    builder.level({0, 3.9}, {kAisle, kAisle}, 0);
    builder.level({0, 0.7}, {0.7, 3.9}, 0);
    builder.level({3.9, 0.7}, {kAisle, 3.9}, 0);
    return builder;
}

MeshBuilder corner_wood() {
    MeshBuilder builder;
    add_coffers(builder, {0, 0}, {kAisle, kAisle}, {4, 4}, kCeiling);
    return builder;
}

MeshBuilder corner_plaster(bool with_stair) {
    MeshBuilder wall;
    wall.wall({0, kGalleryFloor}, {kAisle, kCeiling}, kAisle, -1);
    wall.wall({0, kSpring}, {kWallHalf, kArcadeTop}, kWallHalf, 1);
    MeshBuilder builder;
    add_at_both_walls(builder, wall);
    if (with_stair) {
        add_stair_shaft(builder);
    } else {
        add_groin_vault(builder, {kMiddle, kMiddle}, {kMiddle, kMiddle});
    }
    return builder;
}

MeshBuilder corner_tiles(bool with_stair) {
    MeshBuilder builder;
    builder.level({0.7, 0.7}, {3.9, 3.9}, 0);
    if (with_stair) {
        add_square_with_hole(builder, kGalleryFloor, true);
    } else {
        builder.level({0, 0}, {kAisle, kAisle}, kGalleryFloor);
    }
    return builder;
}

}  // namespace kilolux
