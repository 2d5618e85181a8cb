// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/atrium/column.h"

#include <cmath>
#include <numbers>

#include "host/scene/generated/atrium/plan.h"

namespace kilolux {
namespace {

using atrium_plan::kGalleryFloor;
using atrium_plan::kSpring;
using atrium_plan::kUpperSpring;

constexpr double kShaftBottom = 0.36;  // [m]
constexpr double kShaftTop = 2.92;
constexpr double kRadius = 0.30;
constexpr int kFlutes = 18;

// Entasis: the shaft thins towards the top, along a parabola.
double shaft_radius(double share) { return kRadius * (1.0 - 0.14 * share * share); }

// Depth of the fluting at an angle; flutes run out at the ends of the shaft.
double flute_depth(double angle, double share) {
    const double turn = angle * kFlutes / (2.0 * std::numbers::pi);
    const double across = 2.0 * (turn - std::floor(turn)) - 1.0;  // -1..1 over a flute
    const double half = std::abs(across) / 0.86;
    const double scoop = half < 1.0 ? std::sqrt(1.0 - half * half) : 0.0;
    const double end = std::min(share, 1.0 - share) / 0.05;
    return 0.022 * scoop * (end < 1.0 ? std::sqrt(end * (2.0 - end)) : 1.0);
}

// Torus of `points` from (x, y) up by `height`, bulging outwards.
void add_bulge(Profile& profile, double x, double y, double height, int points) {
    for (int i = 0; i <= points; ++i) {
        const double angle = std::numbers::pi * i / points - 0.5 * std::numbers::pi;
        profile.points.emplace_back(x + 0.5 * height * std::cos(angle),
                                    y + 0.5 * height * (1.0 + std::sin(angle)));
    }
}

void add_base(MeshBuilder& builder) {
    builder.box({-0.42, 0.0, -0.42}, {0.42, 0.12, 0.42});
    Profile base{{{0.30, 0.12}}, 0.7};
    add_bulge(base, 0.35, 0.12, 0.10, 6);
    base.points.insert(base.points.end(), {{0.345, 0.225}, {0.325, 0.25}, {0.335, 0.275}});
    add_bulge(base, 0.325, 0.28, 0.06, 5);
    base.points.insert(base.points.end(), {{0.315, 0.345}, {kRadius, kShaftBottom}});
    builder.lathe(base, 22);
}

// Radius of the capital's bell at a height above the shaft.
double bell_radius(double y) {
    const double t = y / 0.55;
    return 0.255 + 0.03 * t + 0.09 * t * t * t;
}

// A leaf that leans on the bell and curls out and down at its tip; both faces.
void add_leaf(MeshBuilder& builder, double angle, double height, double width) {
    const auto surface = [=](double u, double v) {
        const double curl = std::max(v - 0.62, 0.0) / 0.38;
        const double y = height * (v - 0.30 * curl * curl);
        const double across = 2.0 * u - 1.0;
        const double lobes = 0.86 + 0.14 * std::cos(v * 5.0 * std::numbers::pi);
        const double half = width * lobes * (0.75 + 0.55 * v - 1.05 * v * v * v);
        const double out = bell_radius(std::max(y, 0.0)) + 0.014 + 0.085 * curl * curl +
                           0.018 * (1.0 - std::abs(across)) - 0.02 * across * across;
        const glm::dvec3 radial(std::cos(angle), 0.0, -std::sin(angle));
        const glm::dvec3 side(-std::sin(angle), 0.0, -std::cos(angle));
        return out * radial + across * half * side + glm::dvec3(0.0, kShaftTop + 0.03 + y, 0.0);
    };
    builder.smooth_patch(4, 6, surface, {2.0 * width, height});
    // The back shows where the tip curls over.
    builder.smooth_patch(
        2, 2, [&](double u, double v) { return surface(u, 0.62 + 0.38 * v); },
        {2.0 * width, 0.4 * height}, true);
}

// A spiral scroll under a corner of the abacus, in the vertical plane through the axis.
void add_volute(MeshBuilder& builder, double angle) {
    const glm::dvec3 radial(std::cos(angle), 0.0, -std::sin(angle));
    std::vector<glm::dvec3> path;
    for (int i = 0; i <= 5; ++i) {
        const double t = i / 5.0;
        path.push_back((0.28 + 0.15 * t * t) * radial +
                       glm::dvec3(0.0, kShaftTop + 0.26 + 0.27 * t, 0.0));
    }
    constexpr int kTurnSteps = 11;
    const glm::dvec3 eye = 0.455 * radial + glm::dvec3(0.0, kShaftTop + 0.46, 0.0);
    for (int i = 0; i <= kTurnSteps; ++i) {
        const double t = static_cast<double>(i) / kTurnSteps;
        const double turn = 0.55 * std::numbers::pi - 3.0 * std::numbers::pi * t;
        const double r = 0.085 * (1.0 - 0.75 * t);
        path.push_back(eye + r * (std::cos(turn) * radial + glm::dvec3(0.0, std::sin(turn), 0.0)));
    }
    builder.tube(path, 0.026, 4);
}

void add_abacus(MeshBuilder& builder) {
    const double bottom = kShaftTop + 0.55;
    const double middle = kSpring - 0.06;
    const Profile profile{{{0.40, bottom}, {0.40, bottom + 0.03}, {0.44, middle}, {0.44, kSpring}},
                          0.3};
    // Both ends of an edge start at the axis; the mitre gives the edge its length.
    const glm::dvec3 up(0, 1, 0);
    const glm::dvec3 out(0, 0, 1);
    const SweepFrame edge[2] = {{glm::dvec3(0.0), {-1, 0, 1}, up, out, -0.42},
                                {glm::dvec3(0.0), {1, 0, 1}, up, out, 0.42}};
    MeshBuilder one;
    one.sweep(profile, edge);
    for (int side = 0; side < 4; ++side) builder.append(one, placed(glm::dvec3(0.0), side));
    builder.level({-0.40, -0.40}, {0.40, 0.40}, bottom, -1);
    builder.level({-0.44, -0.44}, {0.44, 0.44}, kSpring);
}

void add_capital(MeshBuilder& builder) {
    Profile bell{{{0.258, kShaftTop - 0.04}, {0.285, kShaftTop - 0.01}, {0.285, kShaftTop + 0.02}},
                 0.5};
    for (int i = 0; i <= 6; ++i) {
        const double y = 0.55 * i / 6;
        bell.points.emplace_back(bell_radius(y), kShaftTop + 0.02 + y);
    }
    builder.lathe(bell, 16);
    for (int i = 0; i < 8; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / 8;
        add_leaf(builder, angle, 0.27, 0.085);
        add_leaf(builder, angle + std::numbers::pi / 8, 0.44, 0.09);
    }
    for (int i = 0; i < 4; ++i)
        add_volute(builder, std::numbers::pi / 4 + i * std::numbers::pi / 2);
}

}  // namespace

MeshBuilder column_shaft() {
    MeshBuilder builder;
    const double height = kShaftTop - kShaftBottom;
    // Rows are dense where the flutes run out.
    constexpr double kRows[] = {0.0, 0.015, 0.06, 0.4, 0.7, 0.94, 0.985, 1.0};
    constexpr int kRowCount = 7;
    const auto surface = [=](double u, double share) {
        const double angle = 2.0 * std::numbers::pi * u;
        const double r = shaft_radius(share) - flute_depth(angle, share);
        return glm::dvec3(r * std::cos(angle), kShaftBottom + share * height, -r * std::sin(angle));
    };
    builder.patch(kFlutes * 5, kRowCount, [&](double u, double v) {
        const double share = kRows[std::lround(v * kRowCount)];
        constexpr double kStep = 2e-3;
        const double low = std::max(share - kStep, 0.0);
        const double high = std::min(share + kStep, 1.0);
        const glm::dvec3 n = glm::cross(surface(u + kStep, share) - surface(u - kStep, share),
                                        surface(u, high) - surface(u, low));
        return SurfacePoint{surface(u, share), n, {2.0 * u, -share * height}};
    });
    return builder;
}

MeshBuilder column_stones() {
    MeshBuilder builder;
    add_base(builder);
    add_capital(builder);
    add_abacus(builder);
    return builder;
}

MeshBuilder gallery_column() {
    MeshBuilder builder;
    const double top = kUpperSpring - kGalleryFloor;
    builder.box({-0.21, 0.0, -0.21}, {0.21, 0.14, 0.21});
    Profile profile{{{0.16, 0.14}}, 0.5};
    add_bulge(profile, 0.165, 0.14, 0.07, 4);
    profile.points.insert(
        profile.points.end(),
        {Point2(0.15, 0.23), Point2(0.135, 0.26), Point2(0.13, 1.0), Point2(0.118, top - 0.40),
         Point2(0.14, top - 0.38), Point2(0.14, top - 0.35), Point2(0.118, top - 0.34),
         Point2(0.13, top - 0.24), Point2(0.17, top - 0.16), Point2(0.20, top - 0.12)});
    builder.lathe(profile, 12);
    builder.box({-0.22, top - 0.12, -0.22}, {0.22, top, 0.22});
    return builder.moved({0.0, kGalleryFloor, 0.0});
}

}  // namespace kilolux
