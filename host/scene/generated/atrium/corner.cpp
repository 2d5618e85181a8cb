// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/atrium/pieces.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/scene/generated/atrium/arch.h"
#include "host/scene/generated/atrium/plan.h"

namespace kilolux {
namespace {

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
