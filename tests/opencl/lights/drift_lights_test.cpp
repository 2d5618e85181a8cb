// SPDX-License-Identifier: Apache-2.0
#include "host/stages/lights/drift_lights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "host/stages/lights/move_lights.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

using Point = std::array<double, 3>;

// The path of a light.
struct Path {
    Point min{}, extent{}, turns{}, rate{};

    Point at(double seconds) const {
        Point out{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            double t = turns[axis] + rate[axis] * seconds;
            t -= std::floor(t);
            out[axis] = min[axis] + 2.0 * extent[axis] * std::min(t, 1.0 - t);
        }
        return out;
    }
};

// Paths of one box on the device.
class Drift {
 public:
    explicit Drift(const std::vector<Path>& paths, int chunks = 16, float range = 2.5f)
        : tuning_(tuning_of(chunks)), lights_(gpu_, tuning_), count_(paths.size()) {
        const DriftBox box = drift_box(paths[0].min, paths[0].extent, range);
        const std::span<LightDrift> rows = lights_.stage(count_, {&box, 1});
        for (std::size_t i = 0; i < count_; ++i) {
            const auto number = static_cast<float>(i);
            rows[i] = light_drift(paths[i].turns, paths[i].rate, {number, 2.0f, 3.0f}, 0);
        }
        lights_.upload();
    }

    // Rows from `first` on, ordered by their places at `ordered`.
    std::vector<WorldLight> rows(double seconds, double ordered = 0.0, std::size_t first = 0) {
        const DeviceArray<WorldLight> world(
            new_buffer(gpu_, std::vector<WorldLight>(first + count_ + 1)));
        StageTimer timer;
        lights_.order(ordered, timer);
        lights_.place(world, first, seconds, timer);
        return download(gpu_, world);
    }
    std::vector<std::uint32_t> order() const { return lights_.download_order(); }

 private:
    Tuning tuning_of(int chunks) const {
        Tuning out = default_tuning(gpu_.info);
        out.cull_chunks = chunks;
        return out;
    }

    Gpu gpu_ = test_gpu();
    Tuning tuning_;
    DriftLights lights_;
    std::size_t count_;
};

Point position(const WorldLight& row) {
    const float4 &high = row.light.position_range, &low = row.position_low;
    return {double{high.x} + low.x, double{high.y} + low.y, double{high.z} + low.z};
}

double distance(const Point& a, const Point& b) {
    return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

std::vector<Path> random_paths(std::size_t count, const Point& min, const Point& extent) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::vector<Path> out(count, {min, extent, {}, {}});
    for (Path& path : out) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            path.turns[axis] = unit(random);
            path.rate[axis] = unit(random) - 0.5;
        }
    }
    return out;
}

TEST(DriftLights, MoveAsDoublesDo) {
    for (const double far : {0.0, 10.0, 1048576.0}) {
        const std::vector<Path> paths =
            random_paths(50, {far * -0.3, far * 0.1, far * 0.4}, {40.0, 3.0, 17.0});
        Drift drift(paths);
        for (const double seconds : {0.0, 0.3, 1.0, 2.625, 1000.75}) {
            const std::vector<WorldLight> rows = drift.rows(seconds);
            const std::vector<std::uint32_t> order = drift.order();
            ASSERT_EQ(order.size(), paths.size());
            for (std::size_t i = 0; i < paths.size(); ++i) {
                // Doubles lose bits of the turns, too: those of whole turns.
                const double most = std::ldexp(40.0 + far, -45) + std::ldexp(seconds * 40.0, -51);
                EXPECT_LE(distance(position(rows[i]), paths[order[i]].at(seconds)), most)
                    << far << ' ' << seconds << ' ' << i;
            }
        }
    }
}

TEST(DriftLights, TurnAtTheEndsOfTheirBox) {
    std::vector<Path> paths;
    for (const double turns : {0.0, 0.25, 0.5, 0.75, 0.999999999}) {
        for (const double rate : {-0.499, -0.25, 0.0, 0.25, 0.499}) {
            paths.push_back({{1.0, 1.0, 1.0}, {4.0, 0.0, 2.0}, {turns, turns, turns}, {}});
            paths.back().rate.fill(rate);
        }
    }
    Drift drift(paths);
    const std::vector<WorldLight> rows = drift.rows(0.999);
    const std::vector<std::uint32_t> order = drift.order();
    for (std::size_t i = 0; i < paths.size(); ++i) {
        EXPECT_LE(distance(position(rows[i]), paths[order[i]].at(0.999)), std::ldexp(5.0, -45));
    }
}

TEST(DriftLights, RowsArePointLightsOfTheirIntensity) {
    Drift drift(random_paths(3, {0, 0, 0}, {1, 1, 1}));
    const std::vector<WorldLight> rows = drift.rows(0.0, 0.0, 2);
    const std::vector<std::uint32_t> order = drift.order();
    for (const std::size_t other : {0u, 1u, 5u}) {
        EXPECT_EQ(rows[other].light.position_range.w, 0.0f) << "another's row " << other;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const Light& light = rows[2 + i].light;
        EXPECT_EQ(light.position_range.w, 2.5f);
        EXPECT_EQ(light.color_scale.x, static_cast<float>(order[i]));
        EXPECT_EQ(light.color_scale.z, 3.0f);
        EXPECT_EQ(light.color_scale.w, 1.0f);
        EXPECT_EQ(light.axis_cos.w, -1.0f);
    }
}

double mean_step(const std::vector<WorldLight>& rows, std::size_t count) {
    double sum = 0.0;
    for (std::size_t i = 1; i < count; ++i) {
        const Point a = position(rows[i - 1]), b = position(rows[i]);
        sum += std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    }
    return sum / static_cast<double>(count - 1);
}

TEST(DriftLights, NeighboursInSpaceAreNeighbours) {
    constexpr std::size_t kCount = 20000;
    Drift drift(random_paths(kCount, {-20, -20, -20}, {40, 40, 40}));
    // 1.5 m from one to the next on a lattice; 26 m at random.
    EXPECT_LT(mean_step(drift.rows(0.0, 0.0), kCount), 4.0);
    EXPECT_LT(mean_step(drift.rows(7.5, 7.5), kCount), 4.0);
    EXPECT_GT(mean_step(drift.rows(7.5, 0.0), kCount), 15.0) << "of other places";
}

// Stable, and the same for any chunks: each number occurs once, and cells alone decide the order.
TEST(DriftLights, OrderIsAPermutationForAnyChunks) {
    for (const std::size_t count : {1u, 2u, 255u, 257u, 70001u}) {
        const std::vector<Path> paths = random_paths(count, {3, -20, 5}, {9, 40, 1});
        Drift drift(paths, 16);
        drift.rows(1.5, 1.5);
        const std::vector<std::uint32_t> expected = drift.order();
        std::vector<std::uint32_t> numbers = expected;
        std::ranges::sort(numbers);
        for (std::uint32_t i = 0; i < count; ++i) ASSERT_EQ(numbers[i], i);
        for (const int chunks : {1, 7}) {
            Drift other(paths, chunks);
            other.rows(1.5, 1.5);
            EXPECT_EQ(other.order(), expected) << chunks << " chunks of " << count;
        }
    }
}

TEST(DriftLights, EqualPlacesKeepTheirOrder) {
    Path path{{0, 0, 0}, {8, 8, 8}, {0.3, 0.3, 0.3}, {}};
    Drift drift(std::vector<Path>(1000, path));
    drift.rows(0.0);
    EXPECT_TRUE(std::ranges::is_sorted(drift.order()));
}

TEST(DriftLights, BoxesOfAnySize) {
    for (const double extent : {0.0, 1e-6, 1e6, 1e12}) {
        const std::vector<Path> paths =
            random_paths(100, {-extent, extent, 0.0}, {extent, extent, extent});
        Drift drift(paths, 16, 1e-3f);
        const std::vector<WorldLight> rows = drift.rows(0.5, 0.5);
        const std::vector<std::uint32_t> order = drift.order();
        for (std::size_t i = 0; i < paths.size(); ++i) {
            EXPECT_LE(distance(position(rows[i]), paths[order[i]].at(0.5)),
                      std::ldexp(2.0 * extent, -45))
                << extent;
        }
    }
}

TEST(DriftLights, NoLightsAreNone) {
    const Gpu gpu = test_gpu();
    DriftLights lights(gpu, default_tuning(gpu.info));
    EXPECT_TRUE(lights.stage(0, {}).empty());
    lights.upload();
    StageTimer timer;
    lights.order(0.0, timer);
    lights.place({}, 0, 0.0, timer);
    EXPECT_TRUE(lights.download_order().empty());
}

}  // namespace
}  // namespace kilolux
