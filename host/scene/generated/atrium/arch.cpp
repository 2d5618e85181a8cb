// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/atrium/arch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/scene/generated/atrium/plan.h"

namespace kilolux {
namespace {

constexpr double kWedge = 0.25;  // [m] of texture that one voussoir takes

// Point on the opening's half ellipse, t = 0 at +x, 1 at -x, with its outward normal.
struct ArchPoint {
    glm::dvec3 position;
    glm::dvec3 outward;
};

ArchPoint arch_point(const ArchPanel& panel, double t, double z) {
    const double angle = std::numbers::pi * t;
    const glm::dvec2 c(std::cos(angle), std::sin(angle));
    return {{panel.center + panel.radius_x * c.x, panel.spring + panel.radius_y * c.y, z},
            glm::normalize(glm::dvec3(c.x / panel.radius_x, c.y / panel.radius_y, 0.0))};
}

using namespace atrium_plan;

// Quarter of a groin vault: the barrel along z where it is the higher one, |x/a| <= |z/b|, on the
// side of `sign`. Swapping x and z gives the other two quarters.
void add_sector(MeshBuilder& builder, glm::dvec2 center, glm::dvec2 half, double sign, bool swap) {
    const double a = swap ? half.y : half.x;
    const double b = swap ? half.x : half.y;
    constexpr int kColumns = 14;
    constexpr int kRows = 7;
    builder.patch(kColumns, kRows, [&](double u, double v) {
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

void add_arch_face(MeshBuilder& builder, const ArchPanel& panel, double z, bool to_plus_z) {
    const glm::dvec3 normal(0.0, 0.0, to_plus_z ? 1.0 : -1.0);
    const auto point = [&](double x, double y) {
        return SurfacePoint{{x, y, z}, normal, {to_plus_z ? x : -x, -y}};
    };
    builder.patch(panel.segments, 1, [&](double u, double v) {
        const glm::dvec3 p = arch_point(panel, u, z).position;
        return point(p.x, v < 0.5 ? p.y : panel.top);
    });
    for (const double side : {-1.0, 1.0}) {
        if (!(panel.half_width > panel.radius_x)) break;
        builder.patch(1, 1, [&](double u, double v) {
            const double x = panel.radius_x + u * (panel.half_width - panel.radius_x);
            return point(panel.center + side * x, panel.bottom + v * (panel.top - panel.bottom));
        });
    }
}

void add_arch_reveal(MeshBuilder& builder, const ArchPanel& panel, double z0, double z1) {
    const double around = std::numbers::pi * 0.5 * (panel.radius_x + panel.radius_y);
    builder.patch(panel.segments, 1, [&](double u, double v) {
        const ArchPoint p = arch_point(panel, u, z0 + v * (z1 - z0));
        return SurfacePoint{p.position, -p.outward, {u * around, v * (z1 - z0)}};
    });
    for (const double side : {-1.0, 1.0}) {
        const double x = panel.center + side * panel.radius_x;
        builder.quad({x, panel.bottom, z0}, {x, panel.bottom, z1}, {x, panel.spring, z1},
                     {x, panel.spring, z0}, {-side, 0, 0});
    }
}

std::vector<SweepFrame> arch_frames(const ArchPanel& panel, double z, bool to_plus_z,
                                    double around) {
    std::vector<SweepFrame> frames;
    const glm::dvec3 across(0.0, 0.0, to_plus_z ? 1.0 : -1.0);
    for (int i = 0; i <= panel.segments; ++i) {
        const double t = static_cast<double>(i) / panel.segments;
        const ArchPoint p = arch_point(panel, t, z);
        frames.push_back({p.position, p.outward, across, p.outward, t * around});
    }
    return frames;
}

void add_voussoirs(MeshBuilder& builder, const ArchPanel& panel, double wall_half, double ring,
                   bool to_plus_z) {
    constexpr double kProud = 0.03;
    // An odd number: both ends have the same colour and a keystone closes the arch.
    const double length = std::numbers::pi * panel.radius_x;
    const double wedges = 2.0 * std::round(length / 0.27 / 2.0) + 1.0;
    const Profile profile{{{ring, 0.0}, {ring, kProud}, {0.0, kProud}, {0.0, -wall_half}}, 0.3};
    const double z = to_plus_z ? wall_half : -wall_half;
    builder.sweep(profile, arch_frames(panel, z, to_plus_z, wedges * kWedge));
}

void add_label(MeshBuilder& builder, const ArchPanel& panel, double z, double ring,
               bool to_plus_z) {
    const Profile profile{
        {Point2(ring + 0.11, 0.0), Point2(ring + 0.11, 0.07), Point2(ring + 0.07, 0.09),
         Point2(ring + 0.04, 0.07), Point2(ring + 0.02, 0.045), Point2(ring - 0.01, 0.03)},
        0.9};
    builder.sweep(profile,
                  arch_frames(panel, z, to_plus_z, std::numbers::pi * (panel.radius_x + ring)));
}

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
