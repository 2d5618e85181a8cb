// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/atrium/arch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/scene/generated/atrium/plan.h"

namespace kilolux {
namespace {

using namespace atrium_plan;

// Quarter of a groin vault: the barrel along z where it is the higher one, |x/a| <= |z/b|, on the
// side of `sign`. Swapping x and z gives the other two quarters.
void add_sector(MeshBuilder& builder, glm::dvec2 center, glm::dvec2 half, double sign, bool swap) {
    const double a = swap ? half.y : half.x;
    const double b = swap ? half.x : half.y;
    constexpr int kAcross = 14;
    constexpr int kAlong = 7;
    builder.patch(kAcross, kAlong, [&](double u, double v) {
        const double t = std::sin(0.5 * std::numbers::pi * v);  // |z| / b, dense at the wall
        const double turn = std::numbers::pi * (u - 0.5);
        const double s = std::sin(turn) * t;  // x / a
        const double rise = std::sqrt(std::max(1.0 - s * s, 0.0));
        const glm::dvec2 plan =
            swap ? glm::dvec2(sign * t * b, s * a) : glm::dvec2(s * a, sign * t * b);
        const glm::dvec2 slope = swap ? glm::dvec2(0.0, s / a) : glm::dvec2(s / a, 0.0);
        const glm::dvec3 normal(-slope.x, -rise / kVaultRise, -slope.y);
        const glm::dvec2 uv(sign * t * b,
                            0.5 * (a + kVaultRise) * std::asin(std::clamp(s, -1.0, 1.0)));
        return SurfacePoint{
            {center.x + plan.x, kSpring + kVaultRise * rise, center.y + plan.y}, normal, uv};
    });
}

// Four quads between two rectangles about a centre, given by half extents in x and z and heights.
void add_square_ring(MeshBuilder& builder, glm::dvec2 center, glm::dvec2 outer, double outer_y,
                     glm::dvec2 inner, double inner_y) {
    const auto corner = [&](int i, glm::dvec2 half, double y) {
        static constexpr double kSigns[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
        const double* s = kSigns[i % 4];
        return glm::dvec3(center.x + s[0] * half.x, y, center.y + s[1] * half.y);
    };
    for (int i = 0; i < 4; ++i) {
        const glm::dvec3 a = corner(i, outer, outer_y);
        const glm::dvec3 b = corner(i + 1, outer, outer_y);
        const glm::dvec3 inwards = glm::dvec3(center.x, 0.0, center.y) - 0.5 * (a + b);
        const glm::dvec3 facing =
            outer_y == inner_y ? glm::dvec3(0, -1, 0) : glm::dvec3(inwards.x, 0.0, inwards.z);
        builder.quad(a, b, corner(i + 1, inner, inner_y), corner(i, inner, inner_y), facing);
    }
}

}  // namespace

void add_groin_vault(MeshBuilder& builder, glm::dvec2 center, glm::dvec2 half) {
    for (const double sign : {-1.0, 1.0}) {
        add_sector(builder, center, half, sign, false);
        add_sector(builder, center, half, sign, true);
    }
}

void add_rib(MeshBuilder& builder) {
    // Built along x like every arch, then turned to span z.
    const double half = kAisle / 2;
    const ArchPanel span{
        .center = 0.0, .radius_x = half, .radius_y = kVaultRise, .spring = kSpring, .segments = 20};
    const Profile profile{
        {Point2(0.05, 0.20), Point2(-0.06, 0.20), Point2(-0.08, 0.17), Point2(-0.13, 0.15),
         Point2(-0.13, -0.15), Point2(-0.08, -0.17), Point2(-0.06, -0.20), Point2(0.05, -0.20)},
        0.3};
    MeshBuilder rib;
    rib.sweep(profile, arch_frames(span, 0.0, true, 5.7));
    builder.append(rib, placed({0.0, 0.0, half}, 1));
}

void add_coffers(MeshBuilder& builder, glm::dvec2 low, glm::dvec2 high, glm::ivec2 cells,
                 double y) {
    const glm::dvec2 half = 0.5 * (high - low) / glm::dvec2(cells);
    const double beam = 0.09;
    for (int j = 0; j < cells.y; ++j) {
        for (int i = 0; i < cells.x; ++i) {
            const glm::dvec2 center = low + half * glm::dvec2(2 * i + 1, 2 * j + 1);
            const glm::dvec2 first = half - beam;
            const glm::dvec2 second = first - 0.10;
            add_square_ring(builder, center, half, y, first, y);
            add_square_ring(builder, center, first, y, first, y + 0.14);
            add_square_ring(builder, center, first, y + 0.14, second, y + 0.14);
            add_square_ring(builder, center, second, y + 0.14, second, y + 0.24);
            builder.level(center - second, center + second, y + 0.24, -1);
        }
    }
}

}  // namespace kilolux
