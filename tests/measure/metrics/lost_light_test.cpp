// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/lost_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/base/error.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

RgbImage row_of(const std::vector<double>& lights) {
    RgbImage out = make_rgb_image(static_cast<int>(lights.size()), 1);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        out.rgb[3 * i] = 0.5 * lights[i];
        out.rgb[3 * i + 2] = 0.5 * lights[i];
    }
    return out;
}

TEST(LostLight, SumsWhatPixelsLackAndWhatTheyHaveTooMuch) {
    const LostLight found =
        lost_light(row_of({1.0, 1.0, 0.5, 4.1, 0.0}), row_of({1.0, 2.0, 3.0, 4.0, 0.0}));
    EXPECT_DOUBLE_EQ(found.lost, 3.5 / 10.0);
    EXPECT_NEAR(found.added, 0.1 / 10.0, 1e-15);
    EXPECT_DOUBLE_EQ(found.losing, 2.0 / 4.0);
    EXPECT_EQ(found.x, 2);
    EXPECT_EQ(found.y, 0);
}

// A pixel that lacks a blue light has as much green too much.
TEST(LostLight, CountsChannelsTogether) {
    RgbImage picture = make_rgb_image(1, 1), reference = make_rgb_image(1, 1);
    picture.rgb = {0.0, 1.0, 0.0};
    reference.rgb = {0.0, 0.0, 1.0};
    EXPECT_EQ(lost_light(picture, reference).lost, 0.0);
}

TEST(LostLight, APixelLosesLightBeyondTheShare) {
    const double just = 1.0 - kLosingShare;
    EXPECT_EQ(lost_light(row_of({just + 1e-9}), row_of({1.0})).losing, 0.0);
    EXPECT_EQ(lost_light(row_of({just - 1e-9}), row_of({1.0})).losing, 1.0);
}

TEST(LostLight, OfABlackReferenceIsNothing) {
    const LostLight black = lost_light(row_of({0.0, 0.0}), row_of({0.0, 0.0}));
    EXPECT_EQ(black.lost, 0.0);
    EXPECT_EQ(black.added, 0.0);
    EXPECT_EQ(black.losing, 0.0);
    EXPECT_TRUE(std::isinf(lost_light(row_of({1.0, 0.0}), row_of({0.0, 0.0})).added));
}

TEST(LostLight, NeedsPicturesOfOneSize) {
    const std::string message = message_of<Error>([] {
        lost_light(row_of({1.0}), row_of({1.0, 2.0}));
    });
    EXPECT_TRUE(contains(message, "1x1")) << message;
}

}  // namespace
}  // namespace kilolux
