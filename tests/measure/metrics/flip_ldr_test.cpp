// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "host/base/error.h"
#include "host/measure/metrics/flip_color.h"

namespace kilolux {
namespace {

RgbImage uniform(int width, int height, double r, double g, double b) {
    RgbImage out = make_rgb_image(width, height);
    for (std::size_t i = 0; i < out.rgb.size(); i += 3) {
        out.rgb[i] = r, out.rgb[i + 1] = g, out.rgb[i + 2] = b;
    }
    return out;
}

RgbImage noise(int width, int height, unsigned seed) {
    std::mt19937 random(seed);
    RgbImage out = make_rgb_image(width, height);
    for (double& v : out.rgb) v = static_cast<double>(random()) * 0x1p-32;
    return out;
}

// Smooth blobs with a few hard edges, as in pictures.
RgbImage shapes(int width, int height, double shift) {
    RgbImage out = make_rgb_image(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            double* rgb = &out.rgb[static_cast<std::size_t>(3 * (y * width + x))];
            rgb[0] = 0.5 + 0.5 * std::sin(0.31 * (x + shift) + 0.1 * y);
            rgb[1] = (x + static_cast<int>(shift)) % 13 < 6 ? 0.8 : 0.1;
            rgb[2] = 0.5 + 0.5 * std::cos(0.2 * y - 0.05 * (x + shift));
        }
    }
    return out;
}

TEST(FlipLdr, DefaultObserverIsThePapers) { EXPECT_NEAR(kFlipPixelsPerDegree, 67.0206, 1e-4); }

TEST(FlipLdr, EqualPicturesHaveNoError) {
    const RgbImage a = noise(19, 13, 1);
    EXPECT_EQ(flip_ldr(a, a).error.max, 0.0);
}

// Results of the authors' program (NVlabs/flip, python/flip_api.py, version 1.2, in double), whose
// constants have nine digits.
TEST(FlipLdr, MatchesTheAuthorsProgram) {
    const FlipResult flip = flip_ldr(shapes(31, 22, 0.0), shapes(31, 22, 3.0), 67.0);
    EXPECT_NEAR(flip.error.mean, 0.818622796, 1e-6);
    EXPECT_NEAR(flip.error.max, 0.982219845, 1e-6);
    EXPECT_NEAR(flip.errors[7 * 31 + 5], 0.968636119, 1e-6);
    EXPECT_NEAR(flip.errors[21 * 31 + 30], 0.982107653, 1e-6);
}

TEST(FlipLdr, GreenAgainstBlueIsTheLargestError) {
    const FlipResult flip = flip_ldr(uniform(8, 8, 0, 1, 0), uniform(8, 8, 0, 0, 1));
    EXPECT_NEAR(flip.error.max, 1.0, 1e-12);
    EXPECT_NEAR(flip.error.mean, 1.0, 1e-12);
}

TEST(FlipLdr, IsSymmetric) {
    const RgbImage a = shapes(40, 25, 0.0), b = noise(40, 25, 5);
    const FlipResult ab = flip_ldr(a, b), ba = flip_ldr(b, a);
    for (std::size_t i = 0; i < ab.errors.size(); ++i) EXPECT_EQ(ab.errors[i], ba.errors[i]);
}

TEST(FlipLdr, GrowsWithTheDifference) {
    double last = 0.0;
    for (const double level : {0.3, 0.32, 0.4, 0.6, 1.0}) {
        const double error =
            flip_ldr(uniform(8, 8, 0.2, 0.2, 0.2), uniform(8, 8, level, level, level)).error.mean;
        EXPECT_GT(error, last) << level;
        last = error;
    }
}

TEST(FlipLdr, FineCheckerboardsVanishFromAfar) {
    RgbImage checker = make_rgb_image(64, 64);
    for (int i = 0; i < 64 * 64; ++i) {
        const double v = 0.5 + ((i % 64 + i / 64) % 2 == 0 ? 0.02 : -0.02);
        for (int c = 0; c < 3; ++c) checker.rgb[static_cast<std::size_t>(3 * i + c)] = v;
    }
    const RgbImage flat = uniform(64, 64, 0.5, 0.5, 0.5);
    const double near = flip_ldr(checker, flat, 10.0).error.mean;
    const double far = flip_ldr(checker, flat, 200.0).error.mean;
    EXPECT_LT(far, 0.05 * near);
}

TEST(FlipLdr, ValuesOutsideTheRangeCountAsItsEnds) {
    const RgbImage over = uniform(8, 8, 7.0, -3.0, std::numeric_limits<double>::infinity());
    EXPECT_EQ(flip_ldr(over, uniform(8, 8, 1, 0, 1)).error.max, 0.0);
}

TEST(FlipLdr, NanIsTheLargestErrorAndStaysInItsPixel) {
    RgbImage a = uniform(30, 30, 0, 0, 0);
    const RgbImage b = a;
    a.rgb[3 * (15 * 30 + 20) + 1] = std::numeric_limits<double>::quiet_NaN();
    const FlipResult flip = flip_ldr(a, b);
    EXPECT_EQ(flip.error.max, 1.0);
    EXPECT_EQ(flip.error.x, 20);
    EXPECT_EQ(flip.error.y, 15);
    EXPECT_EQ(std::count(flip.errors.begin(), flip.errors.end(), 0.0), 30 * 30 - 1);
}

TEST(FlipLdr, OnePixelAndThinPicturesWork) {
    const RgbImage a = uniform(1, 1, 1, 1, 1), b = uniform(1, 1, 0, 0, 0);
    EXPECT_GT(flip_ldr(a, b).error.max, 0.5);
    EXPECT_EQ(flip_ldr(noise(1, 50, 1), noise(1, 50, 1)).error.max, 0.0);
    EXPECT_THROW(flip_ldr(a, make_rgb_image(2, 1)), Error);
}

TEST(FlipColor, TransformsInvert) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> unit;
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 rgb = {unit(random), unit(random), unit(random)};
        const glm::dvec3 back = linear_from_ycxcz(ycxcz_from_linear(rgb));
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(back[c], rgb[c], 1e-13);
    }
}

TEST(FlipColor, WhiteIsNeutralAndLabMatchesPublishedValues) {
    const glm::dvec3 white = hunt_lab_from_linear({1, 1, 1});
    EXPECT_NEAR(white[0], 100.0, 1e-10);
    EXPECT_NEAR(white[1], 0.0, 1e-10);
    EXPECT_NEAR(white[2], 0.0, 1e-10);
    // sRGB red: L*a*b* = (53.24, 80.09, 67.20), green: (87.73, -86.18, 83.18), widely tabulated.
    const glm::dvec3 red = hunt_lab_from_linear({1, 0, 0});
    EXPECT_NEAR(red[0], 53.24, 0.01);
    EXPECT_NEAR(red[1], 80.09 * 0.5324, 0.02);
    EXPECT_NEAR(red[2], 67.20 * 0.5324, 0.02);
    const glm::dvec3 green = hunt_lab_from_linear({0, 1, 0});
    EXPECT_NEAR(green[0], 87.73, 0.01);
    EXPECT_NEAR(green[1], -86.18 * 0.8773, 0.02);
    EXPECT_NEAR(green[2], 83.18 * 0.8773, 0.02);
}

}  // namespace
}  // namespace kilolux
