// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/atrium/arch.h"

#include <cmath>
#include <numbers>

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

}  // namespace kilolux
