// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/false_color.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/measure/metrics/rgb_image.h"

namespace kilolux {
namespace {

double luminance(const SrgbCode& c) {
    return 0.2126 * linear_from_srgb(c[0] / 255.0) + 0.7152 * linear_from_srgb(c[1] / 255.0) +
           0.0722 * linear_from_srgb(c[2] / 255.0);
}

TEST(FalseColor, MatchesViridisAtKnownPlaces) {
    // Entries 0, 64, 128, 191 and 255 of the published table of 256, as codes.
    const struct {
        double t;
        int r, g, b;
    } known[] = {{0.0, 68, 1, 84},
                 {64 / 255.0, 58, 82, 139},
                 {128 / 255.0, 33, 145, 140},
                 {191 / 255.0, 94, 201, 98},
                 {1.0, 253, 231, 37}};
    for (const auto& k : known) {
        const SrgbCode c = viridis(k.t);
        EXPECT_NEAR(c[0], k.r, 6) << k.t;
        EXPECT_NEAR(c[1], k.g, 6) << k.t;
        EXPECT_NEAR(c[2], k.b, 6) << k.t;
    }
}

TEST(FalseColor, BrightensAllTheWay) {
    for (int i = 1; i <= 100; ++i) {
        EXPECT_GT(luminance(viridis(i / 100.0)), luminance(viridis((i - 1) / 100.0))) << i;
    }
}

TEST(FalseColor, ScalesLinearAndLogarithmic) {
    EXPECT_DOUBLE_EQ(scale_position(3.0, {2.0, 4.0}), 0.5);
    EXPECT_EQ(scale_position(-1.0, {2.0, 4.0}), 0.0);
    EXPECT_EQ(scale_position(INFINITY, {2.0, 4.0}), 1.0);
    const FalseColorScale decades{1e-6, 1e-2, true};
    EXPECT_DOUBLE_EQ(scale_position(1e-4, decades), 0.5);
    EXPECT_EQ(scale_position(0.0, decades), 0.0);
    EXPECT_TRUE(std::isnan(scale_position(std::nan(""), decades)));
}

TEST(FalseColor, PictureHasFourOpaqueCodesAPixel) {
    const auto codes = false_color(std::vector<double>{0.0, 1.0, std::nan("")}, {});
    ASSERT_EQ(codes.size(), 12u);
    EXPECT_EQ(codes[3], 255);
    EXPECT_EQ(codes[4], viridis(1.0)[0]);
    EXPECT_EQ((std::vector<std::uint8_t>(codes.begin() + 8, codes.end())),
              (std::vector<std::uint8_t>{255, 0, 255, 255}));
}

}  // namespace
}  // namespace kilolux
