// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/pareto.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace kilolux {
namespace {

using Indices = std::vector<std::size_t>;

TEST(Pareto, ByHand) {
    const std::vector<CostAndError> points = {{3, 1}, {1, 5}, {2, 5}, {2, 2}, {4, 1}, {5, 0.5}};
    EXPECT_EQ(pareto_set(points), (Indices{1, 3, 0, 5}));
}

TEST(Pareto, EqualPointsStayTogetherAndNanNever) {
    const double nan = std::nan("");
    EXPECT_EQ(pareto_set(std::vector<CostAndError>{{1, 1}, {1, 1}, {nan, 0}, {0, nan}, {1, 2}}),
              (Indices{0, 1}));
    EXPECT_TRUE(pareto_set({}).empty());
    EXPECT_EQ(pareto_set(std::vector<CostAndError>{{2, INFINITY}}), (Indices{0}));
}

// Computes the set in another way: walking up in cost, a point stays if its error is below all
// before it.
TEST(Pareto, IsTheStaircaseOfSortedPoints) {
    std::mt19937 random(8);
    for (int round = 0; round < 200; ++round) {
        std::vector<CostAndError> points(1 + random() % 30);
        for (auto& p : points) {
            p = {static_cast<double>(random() % 8), static_cast<double>(random() % 8)};
        }
        double least[8];  // error of points of a cost
        std::fill(std::begin(least), std::end(least), INFINITY);
        for (const auto& p : points) {
            double& l = least[static_cast<int>(p.cost)];
            l = std::min(l, p.error);
        }
        Indices expected;
        double below = INFINITY;
        for (int cost = 0; cost < 8; ++cost) {
            for (std::size_t i = 0; i < points.size() && least[cost] < below; ++i) {
                if (points[i].cost == cost && points[i].error == least[cost]) expected.push_back(i);
            }
            below = std::min(below, least[cost]);
        }
        EXPECT_EQ(pareto_set(points), expected) << "round " << round;
    }
}

constexpr ParetoResolution kQuiet = {kCostResolution, kErrorResolution};

TEST(ParetoOfMeasurements, WhatCannotBeToldApartIsEqual) {
    // Equally fast within 3 %, but ten times as exact.
    EXPECT_EQ(pareto_set(std::vector<CostAndError>{{1.00, 1.0}, {1.02, 0.1}}, kQuiet),
              (Indices{1}));
    // 10 % slower: both stay, unless the noise hides it.
    const std::vector<CostAndError> slower = {{1.0, 1.0}, {1.1, 0.1}};
    EXPECT_EQ(pareto_set(slower, kQuiet), (Indices{0, 1}));
    EXPECT_EQ(pareto_set(slower, {0.2, kErrorResolution}), (Indices{1}));
    // Equally exact within 0.5 dB, but slower.
    const std::vector<CostAndError> close = {{1.0, 1.0}, {1.5, 0.97}, {1.5, 0.9}};
    EXPECT_EQ(pareto_set(close, kQuiet), (Indices{0, 2}));
    // Equal in both: all stay.
    const std::vector<CostAndError> same = {{1.01, 1.0}, {1.0, 1.0}, {1.0, 1.0}};
    EXPECT_EQ(pareto_set(same, kQuiet), (Indices{1, 2, 0}));
    // An exact picture, and an error of 0 as the first.
    EXPECT_EQ(pareto_set(std::vector<CostAndError>{{1.0, 0.0}, {2.0, 0.5}}, kQuiet), (Indices{0}));
}

// Each is a little cheaper and a little less exact than the one before: each pair is equal, but the
// ends are not. Some points must stay, and they must beat all others.
TEST(ParetoOfMeasurements, WhatIsLeftOutIsBeatenByWhatIsLeft) {
    std::mt19937 random(5);
    for (int round = 0; round < 200; ++round) {
        std::vector<CostAndError> points;
        for (int i = 0; i < 12; ++i)
            points.push_back({1.0 + 1e-3 * static_cast<double>(random() % 200),
                              1.0 + 1e-3 * static_cast<double>(random() % 400)});
        const Indices front = pareto_set(points, kQuiet);
        ASSERT_FALSE(front.empty());
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (std::ranges::count(front, i) > 0) continue;
            const bool beaten = std::ranges::any_of(front, [&](std::size_t f) {
                const std::vector<CostAndError> pair = {points[0], points[f], points[i]};
                return std::ranges::count(pareto_set(pair, kQuiet), 2u) == 0;
            });
            EXPECT_TRUE(beaten) << "round " << round << " point " << i;
        }
    }
}

TEST(ParetoOfMeasurements, NanAndInfinityAreNotOfUse) {
    const double inf = INFINITY, nan = std::nan("");
    const std::vector<CostAndError> points = {{inf, 0.5}, {1.0, 1.0}, {nan, 0.0}, {2.0, 0.5}};
    EXPECT_EQ(pareto_set(points, kQuiet), (Indices{1, 3}));
}

}  // namespace
}  // namespace kilolux
