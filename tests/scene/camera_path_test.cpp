// SPDX-License-Identifier: Apache-2.0
// The way of a camera through keys, and around a scene.
#include "host/scene/camera_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace kilolux {
namespace {

double far_apart(const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b); }

std::vector<CameraKey> some_keys() {
    return {{-1.0, {0, 1, 5}, {0, 0, 0}, 50.0},
            {0.5, {3, 2, 4}, {0, 1, 0}, 30.0},
            {1.0, {4, 2, 0}, {0, 1, 1}, 30.0},
            {4.0, {0, 3, -6}, {1, 0, 0}, 90.0}};
}

TEST(CameraPath, PassesItsKeysAndHoldsItsEnds) {
    const CameraPath path(some_keys());
    for (const CameraKey& key : some_keys()) {
        EXPECT_LT(far_apart(path.at(key.time).position, key.position), 1e-12);
        EXPECT_LT(far_apart(path.at(key.time).focal_point, key.focal_point), 1e-12);
        EXPECT_NEAR(path.at(key.time).angle, key.angle, 1e-12);
    }
    EXPECT_EQ(path.at(-7.0).position, some_keys().front().position);
    EXPECT_EQ(path.at(9.0).position, some_keys().back().position);
    const CameraPath one({some_keys()[1]});
    EXPECT_EQ(one.at(2.0).position, some_keys()[1].position);
}

// Position and speed are continuous: their change over a microsecond is small.
TEST(CameraPath, IsSmooth) {
    const CameraPath path(some_keys());
    constexpr double kStep = 1e-6;
    for (const double time : {0.5, 1.0}) {
        const glm::dvec3 before = (path.at(time).position - path.at(time - kStep).position) / kStep;
        const glm::dvec3 after = (path.at(time + kStep).position - path.at(time).position) / kStep;
        EXPECT_LT(far_apart(before, after), 1e-4 * glm::length(after)) << time;
        EXPECT_GT(glm::length(after), 0.5) << "it does not stop at a key";
    }
}

// Keys on a parabola of time, at unequal distances, give back the parabola between inner keys.
TEST(CameraPath, FollowsParabolas) {
    const auto place = [](double t) { return glm::dvec3(t, 2.0 - t * t, 0.5 * t * t); };
    std::vector<CameraKey> keys;
    for (const double t : {0.0, 0.5, 2.0, 2.5, 4.0})
        keys.push_back({t, place(t), {0, 0, -9}, 45.0});
    const CameraPath path(keys);
    for (double t = 0.5; t <= 2.5; t += 0.125) {
        EXPECT_LT(far_apart(path.at(t).position, place(t)), 1e-12) << t;
    }
}

TEST(CameraPath, StandsStillBetweenEqualKeysAndKeepsItsAngleWithinThem) {
    const CameraPath path({{0, {0, 0, 0}, {0, 0, -1}, 20.0},
                           {1, {1, 0, 0}, {0, 0, -1}, 170.0},
                           {2, {1, 0, 0}, {0, 0, -1}, 170.0},
                           {3, {5, 0, 0}, {0, 0, -1}, 160.0},
                           {4, {6, 0, 0}, {0, 0, -1}, 10.0}});
    for (double t = 1.0; t <= 2.0; t += 0.125) {
        EXPECT_EQ(path.at(t).position, glm::dvec3(1, 0, 0)) << t;
    }
    for (double t = 0.0; t <= 4.0; t += 0.01) {
        EXPECT_GE(path.at(t).angle, 10.0 - 1e-9) << t;
        EXPECT_LE(path.at(t).angle, 170.0 + 1e-9) << t;
    }
}

TEST(CameraPath, TurnsAroundTheVerticalAxis) {
    const Camera camera = look_at({1, 2, 7}, {1, 0.5, 2}, {0, 1, 0}, 0.8);
    const glm::dvec3 centre(1, 0, 2);
    const Camera quarter = turned(camera, centre, 90.0);
    // From ahead (+Z) to the right (+X): counter-clockwise as seen from above.
    EXPECT_LT(far_apart(quarter.position, {6, 2, 2}), 1e-12);
    const Camera expected = look_at({6, 2, 2}, {1, 0.5, 2}, {0, 1, 0}, 0.8);
    for (int i = 0; i < 3; ++i) {
        EXPECT_LT(far_apart(quarter.world_from_view[i], expected.world_from_view[i]), 1e-12);
    }
    EXPECT_EQ(turned(camera, centre, 0.0), camera);
}

}  // namespace
}  // namespace kilolux
