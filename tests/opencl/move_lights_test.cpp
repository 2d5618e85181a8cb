// SPDX-License-Identifier: Apache-2.0
#include "host/stages/move_lights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

using Point = std::array<double, 3>;

WorldLight light_at(const Point& p) {
    const PointPair pair = point_pair(p[0], p[1], p[2]);
    WorldLight out{};
    out.light.position_range = {pair.high.x, pair.high.y, pair.high.z, 2.5f};
    out.light.color_scale = {1.0f, 2.0f, 3.0f, 4.0f};
    out.light.axis_cos = {0.0f, 1.0f, 0.0f, 0.5f};
    out.position_low = pair.low;
    return out;
}

std::vector<Light> moved(const std::vector<Point>& points, const Point& eye) {
    const Gpu gpu = test_gpu();
    MoveLights move(gpu, default_tuning(gpu.info));
    std::ranges::transform(points, move.stage(points.size()).begin(), light_at);
    move.upload();
    StageTimer timer;
    return download(gpu, move.enqueue(point_pair(eye[0], eye[1], eye[2]), timer));
}

// The largest error against double's difference, in the float's last places, beside what the pairs
// lose of the positions themselves: 2^-48 of them.
double largest_error(const std::vector<Point>& points, const Point& eye) {
    const std::vector<Light> lights = moved(points, eye);
    double worst = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const float4& p = lights[i].position_range;
        const std::array<float, 3> got = {p.x, p.y, p.z};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double exact = points[i][axis] - eye[axis];
            const double lost = std::ldexp(std::abs(points[i][axis]) + std::abs(eye[axis]), -48);
            const auto rounded = std::abs(static_cast<float>(exact));
            const double ulp =
                std::nextafter(rounded, std::numeric_limits<float>::infinity()) - rounded;
            worst = std::max(worst, (std::abs(got[axis] - exact) - lost) / ulp);
        }
    }
    return worst;
}

std::vector<Point> points_about(const Point& centre, double size) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    std::vector<Point> out(1000);
    for (Point& p : out) {
        for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = centre[axis] + size * unit(random);
    }
    return out;
}

TEST(MoveLights, IsTheDifferenceOfDoubles) {
    for (const double far : {0.0, 1.0, 1e3, 1048576.0, 1e9}) {
        for (const double size : {1e-3, 1.0, 1e3}) {
            const Point centre = {far, -0.3 * far, 0.7 * far};
            const Point eye = {centre[0] + 0.37, centre[1] - 1.61, centre[2] + 0.11};
            EXPECT_LE(largest_error(points_about(centre, size), eye), 0.51) << far << ' ' << size;
        }
    }
}

double drifted(double min, double extent, double turns, double rate, double seconds) {
    double at = turns + rate * seconds;
    at -= std::floor(at);
    return min + 2.0 * extent * std::min(at, 1.0 - at);
}

// A light that drifts in a box, seen from where doubles put it: what is left is the error.
class Drift {
 public:
    double error(const Point& min, const Point& extent, const Point& turns, const Point& rate,
                 double seconds) {
        const DriftBox box = drift_box(min, extent);
        move_.stage(1)[0] = light_at({-1.0, -2.0, -3.0});
        move_.stage_drifts(1, {&box, 1})[0] = light_drift(0, 0, turns, rate);
        move_.upload();
        StageTimer timer;
        move_.drift(seconds, timer);
        Point eye;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            eye[axis] = drifted(min[axis], extent[axis], turns[axis], rate[axis], seconds);
        }
        const PointPair pair = point_pair(eye[0], eye[1], eye[2]);
        const float4 left = download(gpu_, move_.enqueue(pair, timer)).at(0).position_range;
        EXPECT_EQ(left.w, 2.5f);
        return std::max({std::abs(left.x), std::abs(left.y), std::abs(left.z)});
    }

 private:
    Gpu gpu_ = test_gpu();
    MoveLights move_{gpu_, default_tuning(gpu_.info)};
};

TEST(MoveLights, DriftAsDoublesDo) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    Drift drift;
    for (int i = 0; i < 200; ++i) {
        const double far = std::array{0.0, 10.0, 1048576.0}[static_cast<std::size_t>(i % 3)];
        Point min{}, extent{}, turns{}, rate{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            min[axis] = far * (unit(random) - 0.5);
            extent[axis] = 40.0 * unit(random);
            turns[axis] = unit(random);
            rate[axis] = unit(random) - 0.5;
        }
        const double most = 40.0 + far;
        EXPECT_LE(drift.error(min, extent, turns, rate, unit(random)), std::ldexp(most, -45)) << i;
    }
}

TEST(MoveLights, DriftTurnsAtTheEndsOfItsBox) {
    const Point min = {1.0, 1.0, 1.0}, extent = {4.0, 0.0, 2.0};
    Drift drift;
    for (const double turns : {0.0, 0.25, 0.5, 0.75, 0.999999999}) {
        for (const double rate : {-0.499, -0.25, 0.0, 0.25, 0.499}) {
            const double error =
                drift.error(min, extent, {turns, turns, turns}, {rate, rate, rate}, 0.999);
            EXPECT_LE(error, std::ldexp(5.0, -45)) << turns << ' ' << rate;
        }
    }
}

TEST(MoveLights, OnlyTheLightsThatDriftMove) {
    const Gpu gpu = test_gpu();
    MoveLights move(gpu, default_tuning(gpu.info));
    const auto rows = move.stage(3);
    for (WorldLight& row : rows) row = light_at({1.0, 2.0, 3.0});
    const std::array boxes = {drift_box({0, 0, 0}, {1, 1, 1}), drift_box({8, 8, 8}, {4, 4, 4})};
    move.stage_drifts(1, boxes)[0] = light_drift(1, 1, {0.25, 0.25, 0.25}, {0.125, 0.125, 0.125});
    move.upload();
    StageTimer timer;
    move.drift(0.5, timer);
    const auto lights = download(gpu, move.enqueue(point_pair(0, 0, 0), timer));
    EXPECT_EQ(lights.at(0).position_range.x, 1.0f);
    EXPECT_EQ(lights.at(1).position_range.x, 10.5f);
    EXPECT_EQ(lights.at(2).position_range.z, 3.0f);
}

TEST(MoveLights, KeepsTheRestOfALight) {
    const std::vector<Light> lights = moved({{1, 2, 3}}, {0.5, 0.5, 0.5});
    ASSERT_EQ(lights.size(), 1u);
    EXPECT_EQ(lights[0].position_range.x, 0.5f);
    EXPECT_EQ(lights[0].position_range.w, 2.5f);
    EXPECT_EQ(lights[0].color_scale.z, 3.0f);
    EXPECT_EQ(lights[0].axis_cos.w, 0.5f);
}

TEST(MoveLights, NoLightsAreNone) { EXPECT_TRUE(moved({}, {0, 0, 0}).empty()); }

}  // namespace
}  // namespace kilolux
