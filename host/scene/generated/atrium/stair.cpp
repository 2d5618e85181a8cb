// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "host/scene/generated/atrium/pieces.h"
#include "host/scene/generated/atrium/plan.h"

namespace kilolux {
namespace {

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
