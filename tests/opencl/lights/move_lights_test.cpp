// SPDX-License-Identifier: Apache-2.0
#include "host/stages/lights/move_lights.h"

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

// Kernels write the rows of a gap: the stage leaves them alone.
TEST(MoveLights, LeavesAGapForOthers) {
    const Gpu gpu = test_gpu();
    MoveLights move(gpu, default_tuning(gpu.info));
    const auto rows = move.stage(3);
    for (std::size_t i = 0; i < 3; ++i) rows[i] = light_at({static_cast<double>(i), 2.0, 3.0});
    move.upload(1, 2);
    const std::vector<WorldLight> others(2, light_at({7.0, 8.0, 9.0}));
    gpu.queue.enqueueWriteBuffer(move.world(), CL_TRUE, sizeof(WorldLight), 2 * sizeof(WorldLight),
                                 others.data());
    StageTimer timer;
    std::vector<float> found;
    for (const Light& light : download(gpu, move.enqueue(point_pair(0, 0, 0), timer))) {
        found.push_back(light.position_range.x);
    }
    EXPECT_EQ(found, (std::vector<float>{0.0f, 7.0f, 7.0f, 1.0f, 2.0f}));
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
