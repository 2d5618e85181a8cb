// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <cmath>
#include <limits>
#include <random>

#include "host/measure/metrics/flip.h"
#include "host/measure/metrics/flip_hdr.h"

namespace kilolux {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

RgbImage grays(int width, int height, const std::vector<double>& values) {
    RgbImage out = make_rgb_image(width, height);
    for (std::size_t i = 0; i < out.rgb.size(); ++i) out.rgb[i] = values[(i / 3) % values.size()];
    return out;
}

RgbImage bright_noise(int width, int height, unsigned seed) {
    std::mt19937 random(seed);
    RgbImage out = make_rgb_image(width, height);
    for (double& v : out.rgb) v = std::exp(6.0 * static_cast<double>(random()) * 0x1p-32 - 3.0);
    return out;
}

double aces(double x) {
    x *= 0.6;
    return std::clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

TEST(FlipHdr, ToneMapperMatchesItsFormula) {
    for (const double x : {0.0, 0.01, 0.18, 1.0, 3.0, 50.0}) {
        for (const double ev : {-3.0, 0.0, 2.0}) {
            EXPECT_NEAR(flip_tone_map(grays(1, 1, {x}), ev).rgb[0], aces(x * std::exp2(ev)), 1e-14);
        }
    }
}

TEST(FlipHdr, ExposuresPutBrightestAndMedianAtTheSameTone) {
    const RgbImage reference = grays(5, 1, {0.5, 80.0, 2.0, 0.1, 3.0});
    const FlipExposures e = flip_exposures(reference);
    EXPECT_NEAR(flip_tone_map(reference, e.start).rgb[3], 0.85, 1e-9);
    EXPECT_NEAR(flip_tone_map(reference, e.stop).rgb[6], 0.85, 1e-9);
    EXPECT_NEAR(e.stop - e.start, std::log2(80.0 / 2.0), 1e-12);
    EXPECT_EQ(e.count, 6) << "ceil(log2(40))";
}

TEST(FlipHdr, MedianOfAnEvenCountIsTheMiddle) {
    const FlipExposures e = flip_exposures(grays(4, 1, {1.0, 2.0, 4.0, 64.0}));
    EXPECT_NEAR(e.stop - e.start, std::log2(64.0 / 3.0), 1e-12);
}

TEST(FlipHdr, BlackPicturesHaveExposures) {
    const FlipExposures mostly = flip_exposures(grays(5, 1, {0, 0, 0, 4.0, 16.0}));
    EXPECT_NEAR(mostly.stop - mostly.start, std::log2(16.0 / 10.0), 1e-12);
    EXPECT_EQ(mostly.count, 2);
    const FlipExposures black = flip_exposures(grays(3, 1, {0.0}));
    EXPECT_EQ(black.start, 0.0);
    EXPECT_EQ(black.stop, 0.0);
    const FlipExposures odd = flip_exposures(grays(4, 1, {1.0, kInfinite, 4.0, 2.0}));
    EXPECT_NEAR(odd.stop - odd.start, 1.0, 1e-12) << "infinite pixels are left out";
}

TEST(FlipHdr, EqualPicturesHaveNoError) {
    const RgbImage a = bright_noise(20, 20, 2);
    EXPECT_EQ(flip_hdr(a, a).error.max, 0.0);
}

// Most of the picture is dark, some of it very bright: a patch between is burnt out at one end of
// the exposures and nearly black at the other.
TEST(FlipHdr, SeesWhatOnlyMiddleExposuresShow) {
    RgbImage reference = grays(40, 20, {1.0 / 256.0});
    const auto fill = [](RgbImage& image, std::size_t first, std::size_t last, double value) {
        for (std::size_t i = 3 * first; i < 3 * last; ++i) image.rgb[i] = value;
    };
    fill(reference, 0, 80, 256.0);
    fill(reference, 400, 600, 1.0);
    RgbImage test = reference;
    fill(test, 400, 600, 0.7);
    const FlipExposures e = flip_exposures(reference);
    ASSERT_GT(e.count, 4);
    for (const double ev : {e.start, e.stop}) {
        const double end =
            flip_ldr(flip_tone_map(test, ev), flip_tone_map(reference, ev)).error.max;
        EXPECT_LT(3.0 * end, flip_hdr(test, reference).error.max) << ev;
    }
}

// Results of the authors' program (NVlabs/flip, python/flip_api.py, version 1.2, in double).
TEST(FlipHdr, MatchesTheAuthorsProgram) {
    const auto shapes = [](double shift) {
        RgbImage out = make_rgb_image(31, 22);
        for (int y = 0; y < 22; ++y) {
            for (int x = 0; x < 31; ++x) {
                double* rgb = &out.rgb[static_cast<std::size_t>(3 * (y * 31 + x))];
                rgb[0] = 0.5 + 0.5 * std::sin(0.31 * (x + shift) + 0.1 * y);
                rgb[1] = (x + static_cast<int>(shift)) % 13 < 6 ? 0.8 : 0.1;
                rgb[2] = 0.5 + 0.5 * std::cos(0.2 * y - 0.05 * (x + shift));
            }
        }
        for (double& v : out.rgb) v = std::exp(5.0 * v - 2.0);
        return out;
    };
    const FlipExposures exposures = flip_exposures(shapes(0.0));
    const FlipResult flip = flip_hdr(shapes(1.0), shapes(0.0), 67.0);
    EXPECT_NEAR(exposures.start, -2.3718205740171645, 1e-9);
    EXPECT_NEAR(exposures.stop, -1.359748347872564, 1e-9);
    EXPECT_EQ(exposures.count, 2);
    EXPECT_NEAR(flip.error.mean, 0.519210005, 1e-6);
    EXPECT_NEAR(flip.error.max, 0.909702817, 1e-6);
    EXPECT_NEAR(flip.errors[7 * 31 + 5], 0.710341725, 1e-6);
}

TEST(FlipHdr, ScalingBothPicturesChangesNothing) {
    RgbImage a = bright_noise(16, 16, 5), b = bright_noise(16, 16, 6);
    const double before = flip_hdr(a, b).error.mean;
    for (double& v : a.rgb) v *= 1024.0;
    for (double& v : b.rgb) v *= 1024.0;
    EXPECT_NEAR(flip_hdr(a, b).error.mean, before, 1e-12);
}

TEST(FlipHdr, SeesWhatOneExposureHides) {
    RgbImage reference = grays(40, 20, {0.02});
    for (std::size_t i = 0; i < reference.rgb.size() / 4; ++i) reference.rgb[i] = 500.0;
    RgbImage test = reference;
    for (std::size_t i = 0; i < test.rgb.size() / 4; ++i) test.rgb[i] = 250.0;
    const double at_zero =
        flip_ldr(flip_tone_map(test, 0.0), flip_tone_map(reference, 0.0)).error.max;
    EXPECT_LT(at_zero, 1e-9) << "both burnt out";
    EXPECT_GT(flip_hdr(test, reference).error.max, 0.2);
}

TEST(FlipHdr, ExtremeAndBadValues) {
    RgbImage a = bright_noise(20, 20, 7);
    const RgbImage b = a;
    a.rgb[0] = kInfinite;
    a.rgb[30] = 1e300;
    a.rgb[60] = -5.0;
    a.rgb[90] = std::numeric_limits<double>::quiet_NaN();
    const FlipResult flip = flip_hdr(a, b);
    for (const double e : flip.errors) EXPECT_TRUE(e >= 0.0 && e <= 1.0) << e;
    EXPECT_EQ(flip.errors[30], 1.0) << "the pixel with the NaN";
}

}  // namespace
}  // namespace kilolux
