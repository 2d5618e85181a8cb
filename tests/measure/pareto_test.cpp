// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/pareto.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace kilolux {
namespace {

using Indices = std::vector<std::size_t>;

bool beats(const CostAndError& a, const CostAndError& b) {
    return a.cost <= b.cost && a.error <= b.error && (a.cost < b.cost || a.error < b.error);
}

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

TEST(Pareto, IsWhatNoOtherPointBeats) {
    std::mt19937 random(8);
    for (int round = 0; round < 200; ++round) {
        std::vector<CostAndError> points(1 + random() % 30);
        for (auto& p : points) {
            p = {static_cast<double>(random() % 8), static_cast<double>(random() % 8)};
        }
        Indices expected;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const bool beaten = std::any_of(points.begin(), points.end(),
                                            [&](const auto& p) { return beats(p, points[i]); });
            if (!beaten) expected.push_back(i);
        }
        Indices found = pareto_set(points);
        EXPECT_TRUE(std::is_sorted(found.begin(), found.end(), [&](std::size_t a, std::size_t b) {
            return points[a].cost < points[b].cost;
        }));
        std::sort(found.begin(), found.end());
        EXPECT_EQ(found, expected) << "round " << round;
    }
}

TEST(ParetoOfMeasurements, WhatCannotBeToldApartIsEqual) {
    const std::vector<double> quiet(3, 0.0), noisy(3, 0.1);
    // As fast within 3 %, but ten times as exact.
    const std::vector<CostAndError> tie = {{1.00, 1.0}, {1.02, 0.1}};
    EXPECT_EQ(pareto_set(tie, std::span(quiet).first(2)), (Indices{1}));
    // 10 % slower: both stay, unless the noise hides it.
    const std::vector<CostAndError> slower = {{1.0, 1.0}, {1.1, 0.1}};
    EXPECT_EQ(pareto_set(slower, std::span(quiet).first(2)), (Indices{0, 1}));
    EXPECT_EQ(pareto_set(slower, std::span(noisy).first(2)), (Indices{1}));
    // As exact within 0.5 dB, but slower.
    const std::vector<CostAndError> close = {{1.0, 1.0}, {1.5, 0.97}, {1.5, 0.9}};
    EXPECT_EQ(pareto_set(close, quiet), (Indices{0, 2}));
    // Equal in both: all stay.
    const std::vector<CostAndError> same = {{1.01, 1.0}, {1.0, 1.0}, {1.0, 1.0}};
    EXPECT_EQ(pareto_set(same, quiet), (Indices{1, 2, 0}));
}

TEST(ParetoOfMeasurements, NanAndInfinityAreNotOfUse) {
    const double inf = INFINITY, nan = std::nan("");
    const std::vector<CostAndError> points = {{inf, 0.5}, {1.0, 1.0}, {nan, 0.0}, {2.0, 0.5}};
    const std::vector<double> noises(4, 0.0);
    EXPECT_EQ(pareto_set(points, noises), (Indices{1, 3}));
}

}  // namespace
}  // namespace kilolux
