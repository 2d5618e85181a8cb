// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace kilolux {
namespace {

TEST(Statistics, ValuesComputedByHand) {
    const Statistics s = statistics(std::vector<double>{5, 1, 3, 2, 4});
    EXPECT_EQ(s.count, 5u);
    EXPECT_EQ(s.min, 1.0);
    EXPECT_DOUBLE_EQ(s.p5, 1.2);
    EXPECT_EQ(s.median, 3.0);
    EXPECT_DOUBLE_EQ(s.p95, 4.8);
    EXPECT_EQ(s.max, 5.0);
    EXPECT_EQ(s.mean, 3.0);
    EXPECT_EQ(statistics(std::vector<double>{4, 1}).median, 2.5);
}

TEST(Statistics, OneAndNone) {
    const Statistics one = statistics(std::vector<double>{7});
    for (const double v : {one.min, one.p5, one.median, one.p95, one.max, one.mean})
        EXPECT_EQ(v, 7);
    const Statistics none = statistics({});
    EXPECT_EQ(none.count, 0u);
    EXPECT_EQ(none.median, 0.0);
}

TEST(Statistics, NanAndInfinityShow) {
    const double inf = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(std::isnan(statistics(std::vector<double>{1, std::nan(""), 2}).median));
    const Statistics s = statistics(std::vector<double>{1, 2, inf, inf, inf});
    EXPECT_EQ(s.max, inf);
    EXPECT_EQ(s.p95, inf);
    EXPECT_EQ(s.min, 1.0);
}

}  // namespace
}  // namespace kilolux
