// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/atrium/pieces.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/scene/generated/atrium/plan.h"

namespace kilolux {
namespace {

using namespace atrium_plan;

constexpr double kEaveDepth = -0.9;  // [m] of the roof's lower edge in the side's frame

// Height of the roof's plane at a depth z.
double roof_height(double z) {
    return kEaves + (kRidge - kEaves) * (z - kEaveDepth) / (kOuterFace - kEaveDepth);
}

// A profile along the court's edge at depth z; its x points into the court, where the side is
// shorter.
void add_court_course(MeshBuilder& builder, const std::vector<glm::dvec2>& points, double half,
                      double z) {
    const double x = half + z;
    builder.sweep({points, 0.35}, straight_frames({x, 0.0, z}, {-x, 0.0, z}, {0, 0, -1}, -1.0));
}

void add_dentils(MeshBuilder& builder, double half, double z, double y) {
    constexpr double kPitch = 0.24;
    const int count = static_cast<int>(2.0 * (half + z - 0.1) / kPitch);
    for (int i = 0; i < count; ++i) {
        const double x = (i - 0.5 * (count - 1)) * kPitch;
        builder.box({x - 0.07, y, z - 0.15}, {x + 0.07, y + 0.11, z - 0.06});
    }
}

}  // namespace

MeshBuilder side_cornices(double half) {
    MeshBuilder builder;
    add_court_course(
        builder,
        {Point2(0.0, 5.22), Point2(0.04, 5.24), Point2(0.06, 5.30), Point2(0.06, 5.52),
         Point2(0.16, 5.53), Point2(0.30, 5.56), Point2(0.30, 5.64), Point2(0.33, 5.67),
         Point2(0.39, 5.76), Point2(0.40, 5.80), Point2(-kWallHalf, 5.80)},
        half, -kWallHalf);
    add_dentils(builder, half, -kWallHalf, 5.40);
    add_court_course(builder,
                     {Point2(0.0, 9.66), Point2(0.04, 9.68), Point2(0.05, 9.76), Point2(0.05, 9.98),
                      Point2(0.16, 9.99), Point2(0.18, 10.05), Point2(0.24, 10.12),
                      Point2(0.24, 10.16), Point2(0.0, 10.16)},
                     half, -kUpperWallHalf);
    add_dentils(builder, half, -kUpperWallHalf, 9.86);
    return builder;
}

MeshBuilder side_steps(double half) {
    MeshBuilder builder;
    // From the court upwards; treads have a small nosing.
    std::vector<glm::dvec2> points = {{kStepsDepth, kCourtFloor}};
    for (int i = 1; i <= 3; ++i) {
        const double x = kStepsDepth - 0.35 * (i - 1);
        const double y = kCourtFloor + 0.15 * i;
        points.insert(points.end(), {{x - 0.02, y - 0.03}, {x, y - 0.03}, {x, y}});
        points.emplace_back(i < 3 ? x - 0.35 : 0.0, y);
    }
    add_court_course(builder, points, half, 0.0);
    return builder;
}

MeshBuilder side_roof(double half) {
    MeshBuilder builder;
    const double end = half + kOuterFace;
    const int waves = static_cast<int>(2.0 * end / 0.27);
    const auto surface = [=](double u, double v) {
        const double x = end * (1.0 - 2.0 * u);
        const double from = std::clamp(std::abs(x) - half, kEaveDepth, kOuterFace - 0.01);
        const double z = from + v * (kOuterFace - from);
        const double wave = std::cos(2.0 * std::numbers::pi * waves * u);
        return glm::dvec3(x, roof_height(z) + 0.05 * wave, z);
    };
    builder.smooth_patch(waves * 6, 1, surface, {2.0 * end, 5.8});
    const double corner = half + kEaveDepth;
    const glm::dvec3 hip[2] = {{corner, kEaves, kEaveDepth}, {end, kRidge, kOuterFace}};
    builder.tube(hip, 0.13, 8);
    return builder;
}

MeshBuilder side_eaves(double half) {
    MeshBuilder builder;
    const double wall = -kUpperWallHalf;
    const double slope = (kRidge - kEaves) / (kOuterFace - kEaveDepth);
    const double y = kEaves - 0.06;
    // Boards: the edge towards the court, then the underside back to the wall.
    add_court_course(
        builder,
        {{wall - kEaveDepth - 0.02, y}, {wall - kEaveDepth, y}, {wall - kEaveDepth, y + 0.13}},
        half, wall);
    add_court_course(builder,
                     {{0.0, y + slope * (wall - kEaveDepth)}, {wall - kEaveDepth - 0.02, y}}, half,
                     wall);
    MeshBuilder rafter;
    rafter.box({-0.05, y - 0.13, kEaveDepth + 0.06}, {0.05, y + 0.01, wall});
    glm::dmat4 shear(1.0);
    shear[2][1] = slope;
    constexpr double kPitch = 0.4;
    const int count = static_cast<int>(2.0 * (half + kEaveDepth) / kPitch);
    for (int i = 0; i < count; ++i) {
        glm::dmat4 to_place = shear;
        to_place[3] = {(i - 0.5 * (count - 1)) * kPitch, -slope * kEaveDepth, 0.0, 1.0};
        builder.append(rafter, to_place);
    }
    return builder;
}

MeshBuilder side_outer_wall(double half) {
    MeshBuilder builder;
    const double x = half + kOuterFace;
    builder.wall({-x, kCourtFloor}, {x, kRidge}, kOuterFace, 1);
    return builder;
}

MeshBuilder balustrade() {
    MeshBuilder baluster;
    const Profile profile{{Point2(0.055, 0.12), Point2(0.055, 0.17), Point2(0.032, 0.20),
                           Point2(0.068, 0.34), Point2(0.062, 0.42), Point2(0.030, 0.62),
                           Point2(0.030, 0.70), Point2(0.050, 0.73), Point2(0.050, 0.78)},
                          0.9};
    baluster.lathe(profile, 8);
    MeshBuilder builder;
    for (const double center : {-0.5 * kHalfBay, 0.5 * kHalfBay}) {
        builder.box({center - 0.62, 0.0, -0.10}, {center + 0.62, 0.12, 0.10});
        builder.box({center - 0.66, 0.78, -0.11}, {center + 0.66, 0.90, 0.11});
        for (int i = 0; i < 5; ++i) {
            builder.append(baluster, placed({center + 0.22 * (i - 2), 0.0, 0.0}));
        }
    }
    return builder.moved({0.0, kGalleryFloor, 0.0});
}

}  // namespace kilolux
