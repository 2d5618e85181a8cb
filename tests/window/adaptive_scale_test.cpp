// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/adaptive_scale.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kilolux {
namespace {

// Pictures of a machine that takes `fixed` and `per_pixel` ms at scale 1.
double settle(AdaptiveScale& scale, double fixed, double per_pixel, int pictures = 40) {
    for (int i = 0; i < pictures; ++i) {
        const double s = scale.scale(true);
        scale.picture_took(fixed + per_pixel * s * s, s);
    }
    return scale.scale(true);
}

TEST(AdaptiveScale, FindsAScaleThatKeepsTheTarget) {
    for (const double full_ms : {50.0, 120.0, 400.0, 2000.0}) {
        AdaptiveScale scale(80.0);
        const double s = settle(scale, 5.0, full_ms);
        EXPECT_LE(5.0 + full_ms * s * s, 80.0) << full_ms;
        // And wastes less than two steps.
        const double used = 5.0 + full_ms * s * s;
        EXPECT_TRUE(s == 1.0 || used >= 40.0) << full_ms << " at " << s;
    }
}

TEST(AdaptiveScale, DoesNotFlickerOnceItIsThere) {
    AdaptiveScale scale(80.0);
    const double s = settle(scale, 10.0, 300.0);
    for (int i = 0; i < 20; ++i) EXPECT_EQ(settle(scale, 10.0, 300.0, 1), s) << i;
}

// The camera stands: surfaces are made where the size is new, and take three times as long as
// light.
TEST(AdaptiveScale, DoesNotFlickerBetweenSurfacesThatAreKeptAndMade) {
    AdaptiveScale scale(80.0);
    double last = 0.0;
    int changes = 0;
    for (int i = 0; i < 40; ++i) {
        const double now = scale.scale(true);
        changes += now != last ? 1 : 0;
        scale.picture_took(now * now * (now != last ? 160.0 : 40.0), now);
        last = now;
    }
    EXPECT_EQ(changes, 1);
    EXPECT_EQ(scale.scale(true), 1.0);
}

TEST(AdaptiveScale, GrowsBackWhenThereIsRoom) {
    AdaptiveScale scale(80.0);
    EXPECT_LT(settle(scale, 10.0, 1000.0), 0.4);
    EXPECT_EQ(settle(scale, 5.0, 20.0), 1.0);
}

TEST(AdaptiveScale, APictureThatWasGivenUpCountsAtOnce) {
    AdaptiveScale scale(80.0);
    scale.picture_would_take(60'000.0, 1.0);
    EXPECT_EQ(scale.scale(true), AdaptiveScale::kLeast);
    AdaptiveScale fast(80.0);
    fast.picture_would_take(0.0, 1.0);  // given up before anything was known
    EXPECT_EQ(fast.scale(true), 1.0);
}

TEST(AdaptiveScale, IsFullAtRestAndNeverNothing) {
    AdaptiveScale scale(80.0);
    EXPECT_EQ(settle(scale, 1000.0, 1000.0), AdaptiveScale::kLeast);
    EXPECT_EQ(scale.scale(false), 1.0);
    scale.picture_took(0.0, 0.5);
    scale.picture_took(std::nan(""), 0.5);
    EXPECT_EQ(scale.scale(true), AdaptiveScale::kLeast);
}

}  // namespace
}  // namespace kilolux
