// SPDX-License-Identifier: Apache-2.0
#include "host/stages/lights/drift_lights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/base/light_cells.h"
#include "host/base/point_pair.h"
#include "host/stages/lights/move_lights.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

using Point = std::array<double, 3>;

// Whole seconds and 2^-48 of one, of any sign.
DriftTime time_of(double seconds) {
    const double whole = std::floor(seconds);
    const auto units = static_cast<ulong>(static_cast<std::int64_t>(whole));
    const auto rest = static_cast<ulong>(std::ldexp(seconds - whole, 48)) << 16;
    return {high_half(units), low_half(units), high_half(rest), low_half(rest)};
}

// A share of 1 in units of 2^-64, by halves.
ulong units(double share) { return static_cast<ulong>(std::ldexp(share, 64)); }
double share_of(uint high, uint low) {
    return std::ldexp(static_cast<double>(of_halves(high, low)), -64);
}
// Of two's complement.
double rate_of(uint high, uint low) {
    return std::ldexp(static_cast<double>(static_cast<std::int64_t>(of_halves(high, low))), -64);
}

// A box in which the fastest light makes `rate` turns a second along each axis.
struct Place {
    Point min{}, extent{};
    double rate = 0.25;
};

constexpr std::array<float, 3> kGain = {0.5f, 1.0f, 3.0f};

// A swarm of several boxes with equal shares of the lights.
LightSwarm swarm_of(const std::vector<Place>& places, float range = 2.5f, uint seed = 11) {
    LightSwarm out{
        0, seed, 8.0f, static_cast<uint>(places.size()), {kGain[0], kGain[1], kGain[2], 0.0f}, {}};
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto& [min, extent, rate] = places[i];
        const PointPair corner = point_pair(min[0], min[1], min[2]);
        const PointPair size = point_pair(extent[0], extent[1], extent[2]);
        const ulong most = units(2.0 * rate);
        const bool is_last = i + 1 == places.size();
        const ulong share = is_last ? ~ulong{0} : units(static_cast<double>(i + 1) / out.box_count);
        const uint high = high_half(most), low = low_half(most);
        out.boxes[i] = {corner.high,
                        corner.low,
                        size.high,
                        size.low,
                        {high, high, high, high_half(share)},
                        {low, low, low, low_half(share)}};
        out.boxes[i].min.w = range;
        out.boxes[i].extent.w = static_cast<float>(1.0 / light_cell_edge(range));
    }
    return out;
}

// A swarm on the device, and its lights computed in double.
class Drift {
 public:
    explicit Drift(const std::vector<Place>& places, std::size_t count, int chunks = 16,
                   float range = 2.5f)
        : places_(places),
          swarm_(swarm_of(places, range)),
          tuning_(tuning_of(chunks)),
          lights_(gpu_, tuning_),
          count_(count) {
        lights_.set(swarm_, count);
    }

    // Rows from `first` on, ordered by their places at `ordered`.
    std::vector<WorldLight> rows(double seconds, double ordered = 0.0, std::size_t first = 0) {
        const DeviceArray<WorldLight> world(
            new_buffer(gpu_, std::vector<WorldLight>(first + count_ + 1)));
        StageTimer timer;
        lights_.order(time_of(ordered), timer);
        lights_.place(world, first, time_of(seconds), timer);
        return download(gpu_, world);
    }
    std::vector<std::uint32_t> order() const { return lights_.download_order(); }

    LightDrift light(std::uint32_t number) const { return swarm_light(&swarm_, number); }

    Point at(std::uint32_t number, double seconds) const {
        const LightDrift d = light(number);
        const Place& place = places_[d.high.w];
        const Point turns{share_of(d.high.x, d.low.x), share_of(d.high.y, d.low.y),
                          share_of(d.high.z, d.low.z)};
        const Point rate{rate_of(d.rate_high.x, d.rate_low.x), rate_of(d.rate_high.y, d.rate_low.y),
                         rate_of(d.rate_high.z, d.rate_low.z)};
        Point out{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            double t = turns[axis] + rate[axis] * seconds;
            t -= std::floor(t);
            out[axis] = place.min[axis] + 2.0 * place.extent[axis] * std::min(t, 1.0 - t);
        }
        return out;
    }

 private:
    Tuning tuning_of(int chunks) const {
        Tuning out = default_tuning(gpu_.info);
        out.cull_chunks = chunks;
        return out;
    }

    std::vector<Place> places_;
    LightSwarm swarm_;
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

TEST(DriftLights, MoveAsDoublesDo) {
    for (const double far : {0.0, 10.0, 1048576.0}) {
        Drift drift({{{far * -0.3, far * 0.1, far * 0.4}, {40.0, 3.0, 17.0}}}, 50);
        for (const double seconds : {0.0, 0.3125, 1.0, 2.625, 1000.75, -1.25, -77.0000125}) {
            const std::vector<WorldLight> rows = drift.rows(seconds);
            const std::vector<std::uint32_t> order = drift.order();
            ASSERT_EQ(order.size(), 50u);
            for (std::size_t i = 0; i < order.size(); ++i) {
                // The reference in double loses the bits that whole turns take.
                const double most =
                    std::ldexp(40.0 + far, -45) + std::ldexp(std::abs(seconds) * 40.0, -51);
                EXPECT_LE(distance(position(rows[i]), drift.at(order[i], seconds)), most)
                    << far << ' ' << seconds << ' ' << i;
            }
        }
    }
}

// The device chooses each light's box and intensity as the host does.
TEST(DriftLights, RowsAreTheHostsPointLights) {
    Drift drift({{{0, 0, 0}, {1, 1, 1}}, {{10, 0, 0}, {1, 2, 3}}, {{0, 20, 0}, {5, 1, 0}}}, 3000);
    const std::vector<WorldLight> rows = drift.rows(0.75, 0.5, 2);
    const std::vector<std::uint32_t> order = drift.order();
    for (const std::size_t other : {0u, 1u, 3002u}) {
        EXPECT_EQ(rows[other].light.position_range.w, 0.0f) << "another's row " << other;
    }
    std::array<int, 3> lights_of_box{};
    for (std::size_t i = 0; i < order.size(); ++i) {
        const Light& light = rows[2 + i].light;
        const LightDrift expected = drift.light(order[i]);
        ++lights_of_box.at(expected.high.w);
        ASSERT_LE(distance(position(rows[2 + i]), drift.at(order[i], 0.75)), 0x1p-40);
        const std::array<float, 3> host = {std::bit_cast<float>(expected.low.w),
                                           std::bit_cast<float>(expected.rate_high.w),
                                           std::bit_cast<float>(expected.rate_low.w)};
        ASSERT_EQ(light.color_scale.x, host[0] * kGain[0]);
        ASSERT_EQ(light.color_scale.y, host[1] * kGain[1]);
        ASSERT_EQ(light.color_scale.z, host[2] * kGain[2]);
        ASSERT_EQ(*std::ranges::max_element(host), 8.0f);
        ASSERT_EQ(light.position_range.w, 2.5f);
        ASSERT_EQ(light.color_scale.w, 1.0f);
        ASSERT_EQ(light.axis_cos.w, -1.0f);
    }
    // Binomial with 3000 and 1/3: standard deviation 26.
    for (const int lights : lights_of_box) EXPECT_NEAR(lights, 1000, 130);
}

// A light at either end turns back; at the middle of its period it is at the far end.
TEST(DriftLights, TurnAtTheEndsOfTheirBox) {
    const auto share = [](double turns, double rate, double seconds) {
        const ulong speed = units(std::abs(rate));
        return std::ldexp(static_cast<double>(drift_share(
                              units(turns), rate < 0.0 ? 0 - speed : speed, time_of(seconds))),
                          -63);
    };
    EXPECT_EQ(share(0.0, 0.25, 0.0), 0.0);
    EXPECT_EQ(share(0.0, 0.25, 2.0), 1.0);
    EXPECT_EQ(share(0.0, -0.25, 2.0), 1.0);
    EXPECT_EQ(share(0.0, -0.25, 1.5), 0.75);
    EXPECT_EQ(share(0.25, 0.25, 1.5), 0.75);
    EXPECT_EQ(share(0.25, 0.25, 4.0e9), 0.5) << "whole periods";
    EXPECT_EQ(share(0.875, 0.25, 1.0), 0.25);
    EXPECT_EQ(share(0.125, -0.25, 1.0), 0.25);
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
    Drift drift({{{-20, -20, -20}, {40, 40, 40}}}, kCount);
    // 1.5 m from one to the next on a lattice; 26 m at random.
    EXPECT_LT(mean_step(drift.rows(0.0, 0.0), kCount), 4.0);
    EXPECT_LT(mean_step(drift.rows(7.5, 7.5), kCount), 4.0);
    EXPECT_GT(mean_step(drift.rows(7.5, 0.0), kCount), 15.0) << "of other places";
}

// Stable, and the same for any chunks: each number occurs once, and cells alone decide the order.
TEST(DriftLights, OrderIsAPermutationForAnyChunks) {
    for (const std::size_t count : {1u, 2u, 255u, 257u, 70001u}) {
        const Place box{{3, -20, 5}, {9, 40, 1}};
        Drift drift({box}, count, 16);
        drift.rows(1.5, 1.5);
        const std::vector<std::uint32_t> expected = drift.order();
        std::vector<std::uint32_t> numbers = expected;
        std::ranges::sort(numbers);
        for (std::uint32_t i = 0; i < count; ++i) ASSERT_EQ(numbers[i], i);
        for (const int chunks : {1, 7}) {
            Drift other({box}, count, chunks);
            other.rows(1.5, 1.5);
            EXPECT_EQ(other.order(), expected) << chunks << " chunks of " << count;
        }
    }
}

TEST(DriftLights, EqualPlacesKeepTheirOrder) {
    Drift drift({{{1, 2, 3}, {0, 0, 0}}}, 1000);
    drift.rows(0.0);
    EXPECT_TRUE(std::ranges::is_sorted(drift.order()));
}

TEST(DriftLights, BoxesOfAnySize) {
    for (const double extent : {0.0, 1e-6, 1e6, 1e12}) {
        Drift drift({{{-extent, extent, 0.0}, {extent, extent, extent}}}, 100, 16, 1e-3f);
        const std::vector<WorldLight> rows = drift.rows(0.5, 0.5);
        const std::vector<std::uint32_t> order = drift.order();
        for (std::size_t i = 0; i < order.size(); ++i) {
            EXPECT_LE(distance(position(rows[i]), drift.at(order[i], 0.5)),
                      std::ldexp(2.0 * extent, -45))
                << extent;
        }
    }
}

TEST(DriftLights, NoLightsGiveAnEmptyOrder) {
    const Gpu gpu = test_gpu();
    DriftLights lights(gpu, default_tuning(gpu.info));
    lights.set(swarm_of({{}}), 0);
    StageTimer timer;
    lights.order({}, timer);
    lights.place({}, 0, {}, timer);
    EXPECT_TRUE(lights.download_order().empty());
}

}  // namespace
}  // namespace kilolux
