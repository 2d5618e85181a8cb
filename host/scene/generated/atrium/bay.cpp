// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/atrium/bay.h"

#include <cmath>
#include <numbers>

#include "host/scene/generated/atrium/arch.h"
#include "host/scene/generated/atrium/plan.h"

namespace kilolux {
namespace {

using namespace atrium_plan;

constexpr double kRing = 0.30;        // width of the dressed stones round an arch [m]
constexpr double kNicheDepth = 0.35;  // [m]

// A bay's panel with a round-headed opening in its middle.
constexpr ArchPanel bay_panel(double bottom, double top, double radius, double spring,
                              int segments) {
    return {0.0, kHalfBay, bottom, top, radius, radius, spring, segments};
}

constexpr ArchPanel kArcade = bay_panel(kSpring, kArcadeTop, kArchRadius, kSpring, 28);
constexpr ArchPanel kNiche = bay_panel(0.0, kGalleryFloor, 0.95, 2.15, 20);
constexpr ArchPanel kWindow = bay_panel(6.75, kCeiling, 0.55, 8.1, 14);

// One of the two arches of the gallery in a bay.
ArchPanel gallery_panel(double center) {
    return {center,       0.5 * kHalfBay, kUpperSpring, kCeiling,
            kUpperRadius, kUpperRadius,   kUpperSpring, 16};
}

// A moulding on a wall's face at z that faces -z, from x = -half to half.
void add_course(MeshBuilder& builder, const std::vector<glm::dvec2>& points, double half,
                double z) {
    builder.sweep({points, 0.5}, straight_frames({half, 0, z}, {-half, 0, z}, {0, 0, -1}));
}

// A disc that stands out from a wall at z, with a rim.
void add_medallion(MeshBuilder& builder, glm::dvec2 at, double z, bool to_plus_z) {
    const Profile profile{{Point2(0.17, 0.0), Point2(0.17, 0.035), Point2(0.15, 0.05),
                           Point2(0.13, 0.035), Point2(0.12, 0.012), Point2(0.0, 0.03)},
                          0.5};
    std::vector<SweepFrame> frames;
    const glm::dvec3 out(0.0, 0.0, to_plus_z ? 1.0 : -1.0);
    for (int i = 0; i <= 16; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / 16;
        const glm::dvec3 radial(std::cos(angle), std::sin(angle), 0.0);
        frames.push_back({{at.x, at.y, z}, radial, out, radial, i / 16.0});
    }
    builder.sweep(profile, frames);
}

}  // namespace

MeshBuilder arcade_wall() {
    MeshBuilder builder;
    add_arch_face(builder, kArcade, -kWallHalf, false);
    add_arch_face(builder, kArcade, kWallHalf, true);
    return builder;
}

MeshBuilder arcade_voussoirs() {
    MeshBuilder builder;
    add_voussoirs(builder, kArcade, kWallHalf, kRing, false);
    add_voussoirs(builder, kArcade, kWallHalf, kRing, true);
    return builder;
}

MeshBuilder arcade_mouldings() {
    MeshBuilder builder;
    add_label(builder, kArcade, -kWallHalf, kRing, false);
    add_label(builder, kArcade, kWallHalf, kRing, true);
    add_medallion(builder, {-kHalfBay, 4.78}, -kWallHalf, false);
    return builder;
}

MeshBuilder aisle_wall() {
    MeshBuilder builder;
    add_arch_face(builder, kNiche, kAisle, false);
    add_arch_reveal(builder, kNiche, kAisle, kAisle + kNicheDepth);
    return builder;
}

MeshBuilder aisle_plaster() {
    MeshBuilder builder;
    const double z = kAisle + kNicheDepth;
    builder.wall({-1.0, 0.0}, {1.0, 3.2}, z, -1);
    builder.level({-kNiche.radius_x, kAisle}, {kNiche.radius_x, z}, 0.42);
    return builder;
}

MeshBuilder aisle_mouldings() {
    MeshBuilder builder;
    add_label(builder, kNiche, kAisle, 0.10, false);
    for (const double side : {-1.08, 1.08}) {
        builder.box({side - 0.11, kNiche.spring - 0.10, kAisle - 0.11},
                    {side + 0.11, kNiche.spring, kAisle});
    }
    // The parapet below the niche and its sill.
    builder.box({-0.97, 0.0, kAisle - 0.02}, {0.97, 0.40, kAisle + kNicheDepth});
    builder.box({-1.08, 0.40, kAisle - 0.07}, {1.08, 0.46, kAisle + kNicheDepth});
    add_course(builder, {{0.06, 0.0}, {0.06, 0.16}, {0.03, 0.20}, {0.0, 0.21}}, kHalfBay, kAisle);
    // Under the rib at the bay's left end; the right one belongs to the next bay.
    add_pilaster(builder, -kHalfBay);
    return builder;
}

void add_pilaster(MeshBuilder& builder, double x) {
    builder.box({x - 0.30, 0.0, kAisle - 0.20}, {x + 0.30, 0.30, kAisle});
    builder.box({x - 0.24, 0.30, kAisle - 0.15}, {x + 0.24, kSpring - 0.26, kAisle});
    builder.box({x - 0.28, kSpring - 0.26, kAisle - 0.19}, {x + 0.28, kSpring - 0.20, kAisle});
    builder.box({x - 0.25, kSpring - 0.20, kAisle - 0.16}, {x + 0.25, kSpring - 0.10, kAisle});
    builder.box({x - 0.31, kSpring - 0.10, kAisle - 0.22}, {x + 0.31, kSpring + 0.02, kAisle});
}

MeshBuilder gallery_arches() {
    MeshBuilder builder;
    for (const double center : {-0.5 * kHalfBay, 0.5 * kHalfBay}) {
        add_arch_face(builder, gallery_panel(center), -kUpperWallHalf, false);
        add_arch_face(builder, gallery_panel(center), kUpperWallHalf, true);
    }
    return builder;
}

MeshBuilder gallery_stones() {
    MeshBuilder builder;
    for (const double center : {-0.5 * kHalfBay, 0.5 * kHalfBay}) {
        add_voussoirs(builder, gallery_panel(center), kUpperWallHalf, 0.14, false);
        add_voussoirs(builder, gallery_panel(center), kUpperWallHalf, 0.14, true);
    }
    return builder;
}

MeshBuilder gallery_wall() {
    MeshBuilder builder;
    add_arch_face(builder, kWindow, kAisle, false);
    add_arch_reveal(builder, kWindow, kAisle, kAisle + kNicheDepth);
    builder.wall({-kHalfBay, kGalleryFloor}, {kHalfBay, 6.75}, kAisle, -1);
    builder.level({-0.6, kAisle}, {0.6, kAisle + kNicheDepth}, 6.75);
    return builder;
}

MeshBuilder gallery_wood() {
    MeshBuilder builder;
    const double z = kAisle + kNicheDepth - 0.05;
    builder.wall({-0.6, 6.7}, {0.6, 8.7}, z, -1);
    for (int i = 0; i < 8; ++i) {
        const double y = 6.80 + 0.215 * i;
        builder.box({-0.52, y, z - 0.03}, {-0.03, y + 0.14, z});
        builder.box({0.03, y, z - 0.03}, {0.52, y + 0.14, z});
    }
    add_coffers(builder, {-kHalfBay, kUpperWallHalf}, {kHalfBay, kAisle}, {3, 4}, kCeiling);
    return builder;
}

}  // namespace kilolux
