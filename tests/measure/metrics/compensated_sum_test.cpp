// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/compensated_sum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace kilolux {
namespace {

constexpr double kExact = 1e-15;  // relative; the sums of references promise 1e-14

// Integers below 2^53 scaled by powers of two: their sum in 128-bit fixed point is exact.
struct FixedPoint {
    unsigned __int128 units = 0;  // of 2^-60
    void add(std::uint64_t mantissa, int shift) {
        units += static_cast<unsigned __int128>(mantissa) << shift;
    }
    double value() const { return std::ldexp(static_cast<double>(units), -60); }
};

TEST(CompensatedSum, MatchesFixedPointForAMillionTermsOverManyMagnitudes) {
    std::mt19937_64 random(7);
    CompensatedSum sum;
    FixedPoint exact;
    double naive = 0.0;
    for (int i = 0; i < 1'000'000; ++i) {
        const std::uint64_t mantissa = random() >> 11;
        const int shift = static_cast<int>(random() % 50);
        const double term = std::ldexp(static_cast<double>(mantissa), shift - 60);
        sum.add(term);
        naive += term;
        exact.add(mantissa, shift);
    }
    EXPECT_NEAR(sum.value(), exact.value(), kExact * exact.value());
    EXPECT_GT(std::abs(naive - exact.value()), kExact * exact.value()) << "the case is too easy";
}

TEST(CompensatedSum, KeepsWhatCancels) {
    CompensatedSum sum;
    for (const double term : {1.0, 1e100, 1.0, -1e100}) sum.add(term);
    EXPECT_EQ(sum.value(), 2.0);
}

TEST(CompensatedSum, OrderDoesNotMatter) {
    std::vector<double> terms(5000);
    std::mt19937_64 random(3);
    for (double& t : terms) t = std::exp(12.0 * static_cast<double>(random() >> 11) * 0x1p-53);
    CompensatedSum forward, backward;
    for (const double t : terms) forward.add(t);
    for (auto t = terms.rbegin(); t != terms.rend(); ++t) backward.add(*t);
    EXPECT_NEAR(forward.value(), backward.value(), 2.3e-16 * forward.value());
}

TEST(CompensatedSum, InfinityAndNanShow) {
    CompensatedSum infinite, nan;
    infinite.add(std::numeric_limits<double>::infinity());
    infinite.add(1.0);
    nan.add(1.0);
    nan.add(std::numeric_limits<double>::quiet_NaN());
    EXPECT_TRUE(std::isinf(infinite.value()));
    EXPECT_TRUE(std::isnan(nan.value()));
}

TEST(CompensatedSum, OfNothingIsZero) { EXPECT_EQ(CompensatedSum{}.value(), 0.0); }

}  // namespace
}  // namespace kilolux
