// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/atrium/side.h"

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

using namespace atrium_plan;

constexpr glm::dvec3 kAxis(kAisle / 2, 0.0, kAisle / 2);
constexpr int kSteps = 32;
constexpr double kRise = kGalleryFloor / kSteps;  // [m]
constexpr double kInner = 0.15;                   // radius of the newel [m]
constexpr double kOuter = 1.62;
constexpr double kTread = 1.75 * 2.0 * std::numbers::pi / kSteps;  // angle of a step
constexpr double kStart = 0.75 * std::numbers::pi;

glm::dvec3 at(double angle, double radius, double y) {
    return kAxis + glm::dvec3(radius * std::cos(angle), y, -radius * std::sin(angle));
}

// A wedge: tread, riser, outer edge, back and a soffit that slopes like the stair.
void add_step(MeshBuilder& builder, int step) {
    const double a0 = kStart + step * kTread;
    const double a1 = a0 + 1.12 * kTread;  // steps overlap
    const double top = (step + 1) * kRise;
    const double low0 = std::max(top - kRise - 0.12, 0.0);
    const double low1 = std::max(top - 0.12, 0.0);
    const auto fan = [&](double y0, double y1, double facing) {
        builder.patch(1, 3, [&](double u, double v) {
            const double angle = a0 + v * (a1 - a0);
            const double radius = kInner + u * (kOuter - kInner);
            return SurfacePoint{
                at(angle, radius, y0 + v * (y1 - y0)), {0, facing, 0}, {radius, angle}};
        });
    };
    fan(top, top, 1.0);
    fan(low0, low1, -1.0);
    builder.patch(3, 1, [&](double u, double v) {
        const double angle = a0 + u * (a1 - a0);
        const double low = low0 + u * (low1 - low0);
        const double y = low + v * (top - low);
        return SurfacePoint{
            at(angle, kOuter, y), at(angle, 1.0, 0.0) - kAxis, {angle * kOuter, -y}};
    });
    const glm::dvec3 forward = at(a0 + 0.5 * std::numbers::pi, 1.0, 0.0) - kAxis;
    builder.quad(at(a0, kInner, low0), at(a0, kOuter, low0), at(a0, kOuter, top),
                 at(a0, kInner, top), -forward);
    builder.quad(at(a1, kInner, low1), at(a1, kOuter, low1), at(a1, kOuter, top),
                 at(a1, kInner, top), forward);
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

MeshBuilder stair_stones() {
    MeshBuilder builder;
    builder.lathe(
        {{Point2(kInner + 0.02, 0.0), Point2(kInner + 0.02, kGalleryFloor + 0.95),
          Point2(kInner + 0.07, kGalleryFloor + 0.98), Point2(kInner + 0.07, kGalleryFloor + 1.05),
          Point2(0.10, kGalleryFloor + 1.12), Point2(0.0, kGalleryFloor + 1.2)},
         0.5},
        20, kAxis);
    for (int step = 0; step < kSteps; ++step) add_step(builder, step);
    return builder;
}

MeshBuilder stair_rails() {
    MeshBuilder builder;
    constexpr double kRailHeight = 0.92;
    std::vector<glm::dvec3> path;
    for (int i = 0; i <= 2 * kSteps; ++i) {
        const double step = 0.5 * i;
        path.push_back(
            at(kStart + step * kTread, kOuter - 0.06, step * kRise + kRise + kRailHeight));
    }
    builder.tube(path, 0.032, 6);
    for (int step = 0; step < kSteps; ++step) {
        const double angle = kStart + (step + 0.5) * kTread;
        const double foot = (step + 1) * kRise;
        const glm::dvec3 post[2] = {at(angle, kOuter - 0.06, foot),
                                    at(angle, kOuter - 0.06, foot + kRailHeight + 0.5 * kRise)};
        builder.tube(post, 0.014, 5);
    }
    // Round the opening, with a gap at the last steps.
    const double last = kStart + kSteps * kTread;
    std::vector<glm::dvec3> ring;
    constexpr int kPosts = 36;
    for (int i = 0; i <= kPosts; ++i) {
        const double angle = last + 0.55 + (2.0 * std::numbers::pi - 0.85) * i / kPosts;
        ring.push_back(at(angle, 1.85, kGalleryFloor + kRailHeight));
        const glm::dvec3 post[2] = {at(angle, 1.85, kGalleryFloor), ring.back()};
        builder.tube(post, 0.012, 4);
    }
    builder.tube(ring, 0.03, 6);
    return builder;
}

}  // namespace kilolux
