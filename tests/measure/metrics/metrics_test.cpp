// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "host/base/error.h"
#include "host/measure/metrics/error_size.h"

namespace kilolux {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

RgbImage image(int width, int height, std::vector<double> rgb) {
    return {.width = width, .height = height, .rgb = std::move(rgb)};
}

TEST(HdrMetrics, EqualPicturesHaveNoError) {
    const RgbImage a = image(2, 1, {0, 1, 2, 3, 4, 5});
    const HdrMetrics m = compare_hdr(a, a);
    EXPECT_EQ(m.absolute.max, 0.0);
    EXPECT_EQ(m.relative.max, 0.0);
    EXPECT_EQ(m.rmse, 0.0);
    EXPECT_EQ(m.rel_mse, 0.0);
    EXPECT_EQ(m.psnr_db, kInfinity);
    EXPECT_EQ(m.different_pixels, 0u);
    EXPECT_EQ(m.pixels, 2u);
}

TEST(HdrMetrics, ValuesComputedByHand) {
    // Errors 0, 0.5, 0 | 0, 0, 1; reference 1, 2, 0 | 4, 1, 4: mean 2, eps 0.04.
    const RgbImage r = image(2, 1, {1, 2, 0, 4, 1, 4});
    const RgbImage x = image(2, 1, {1, 2.5, 0, 4, 1, 3});
    const HdrMetrics m = compare_hdr(x, r);
    EXPECT_DOUBLE_EQ(m.absolute.mean, 1.5 / 6);
    EXPECT_EQ(m.absolute.max, 1.0);
    EXPECT_EQ(m.absolute.x, 1);
    EXPECT_EQ(m.absolute.y, 0);
    EXPECT_EQ(m.absolute.channel, 2);
    EXPECT_EQ(m.relative.max, 0.25);
    EXPECT_EQ(m.relative.channel, 1);
    EXPECT_EQ(m.relative.x, 0);
    EXPECT_DOUBLE_EQ(m.rmse, std::sqrt(1.25 / 6));
    EXPECT_EQ(m.psnr_peak, 4.0);
    EXPECT_DOUBLE_EQ(m.psnr_db, 20 * std::log10(4 / std::sqrt(1.25 / 6)));
    EXPECT_DOUBLE_EQ(m.rel_mse, (0.25 / 4.04 + 1.0 / 16.04) / 6);
    EXPECT_EQ(m.different_pixels, 2u);
}

TEST(HdrMetrics, ScaleBoundsTheRelativeError) {
    const RgbImage r = image(1, 1, {0.001, 1, 0});
    const RgbImage x = image(1, 1, {0.002, 1, 0.5});
    const RgbImage e = image(1, 1, {10, 10, 10});
    EXPECT_EQ(compare_hdr(x, r).relative.max, kInfinity) << "0.5 against 0 without a scale";
    EXPECT_DOUBLE_EQ(compare_hdr(x, r, {.scale = &e}).relative.max, 0.05);
}

TEST(HdrMetrics, NothingPassesOverNanAndInfinity) {
    for (const double bad : {kNan, kInfinity, -kInfinity}) {
        const RgbImage r = image(3, 1, {1, 1, 1, 1, 1, 1, 1, 1, 1});
        const RgbImage x = image(3, 1, {1, 1, 1, 1, bad, 1, 1, 1, 1});
        const HdrMetrics m = compare_hdr(x, r);
        EXPECT_EQ(m.absolute.max, kInfinity) << bad;
        EXPECT_EQ(m.absolute.x, 1) << bad;
        EXPECT_EQ(m.absolute.mean, kInfinity) << bad;
        EXPECT_EQ(m.rmse, kInfinity) << bad;
        EXPECT_EQ(m.rel_mse, kInfinity) << bad;
        EXPECT_EQ(m.psnr_db, -kInfinity) << bad;
        EXPECT_EQ(m.nan_pixels, std::isnan(bad) ? 1u : 0u);
        EXPECT_EQ(m.infinite_pixels, std::isinf(bad) ? 1u : 0u);
        EXPECT_EQ(m.negative_pixels, bad < 0 ? 1u : 0u);
    }
}

TEST(HdrMetrics, AnInfiniteReferenceHidesNoOtherError) {
    for (const double bad : {kNan, kInfinity}) {
        const RgbImage r = image(2, 1, {1, 1, 1, 1, 1, bad});
        RgbImage x = r;
        EXPECT_EQ(compare_hdr(x, r).rel_mse, 0.0) << bad;
        x.rgb[0] = 1.5;
        EXPECT_DOUBLE_EQ(compare_hdr(x, r).rel_mse, 0.25 / 1.01 / 6) << bad;
    }
}

TEST(HdrMetrics, CountsPixelsNotValues) {
    const RgbImage r = image(2, 2, std::vector<double>(12, 1.0));
    RgbImage x = r;
    x.rgb = {kNan, kNan, 1, -1, -2, 1, -0.0, 1, 1, 1, 1, 1};
    const HdrMetrics m = compare_hdr(x, r);
    EXPECT_EQ(m.nan_pixels, 1u);
    EXPECT_EQ(m.negative_pixels, 1u);
    EXPECT_EQ(m.different_pixels, 3u);
}

TEST(HdrMetrics, DifferentBitsAreThoseOfFloat32) {
    const RgbImage r = image(3, 1, {1.0 + 1e-12, 0, 0, 1.0 + 1e-6, 0, 0, 0.0, 0, 0});
    const RgbImage x = image(3, 1, {1.0, 0, 0, 1.0, 0, 0, -0.0, 0, 0});
    EXPECT_EQ(compare_hdr(x, r).different_pixels, 2u) << "1e-6 and the sign of zero";
}

TEST(HdrMetrics, PercentileIsTheNearestRank) {
    std::vector<double> errors(2000);
    for (std::size_t i = 0; i < errors.size(); ++i) errors[i] = static_cast<double>(i);
    EXPECT_EQ(error_distribution(errors, 2000, 1).percentile_99_9, 1997.0);
    EXPECT_EQ(error_distribution(std::vector<double>{3.0}, 1, 1).percentile_99_9, 3.0);
}

TEST(HdrMetrics, SizesMustAgree) {
    const RgbImage a = image(2, 1, std::vector<double>(6));
    const RgbImage b = image(1, 2, std::vector<double>(6));
    EXPECT_THROW(compare_hdr(a, b), Error);
    EXPECT_THROW(compare_hdr({}, {}), Error);
    EXPECT_THROW(compare_hdr(a, a, {.scale = &b}), Error);
    EXPECT_THROW(rgb_image_of(2, 2, std::vector<float>(11)), Error);
}

TEST(PixelErrors, AreThoseOfTheWorstChannelAndKeepNan) {
    const RgbImage r = image(3, 1, {1, 2, 0, 4, 1, 4, 1, 1, 1});
    const RgbImage x = image(3, 1, {1, 2.5, 0.25, 4, 1, 3, 1, kNan, 3});
    const RgbImage e = image(3, 1, std::vector<double>(9, 2.0));
    const auto absolute = pixel_errors(x, r), relative = pixel_errors(x, r, &e);
    EXPECT_EQ(absolute[0], 0.5);
    EXPECT_EQ(absolute[1], 1.0);
    EXPECT_EQ(relative[0], 0.25);
    EXPECT_EQ(relative[1], 0.25);
    EXPECT_TRUE(std::isnan(absolute[2]));
    EXPECT_THROW(pixel_errors(x, image(1, 3, r.rgb)), Error);
}

TEST(ErrorSize, KeepsTheShapeWithinWidthAndEvaluations) {
    using Size = std::array<int, 2>;
    EXPECT_EQ(error_size({1920, 1080}, 10), (Size{320, 180}));
    EXPECT_EQ(error_size({64, 36}, 10), (Size{64, 36}));
    EXPECT_EQ(error_size({1920, 1080}, 1000000), (Size{23, 12}));
    EXPECT_EQ(error_size({1920, 1080}, 1000000, {.width = 960, .evaluations = kInfinity}),
              (Size{960, 540}));
    EXPECT_EQ(error_size({8192, 1}, 0), (Size{320, 1}));
}

TEST(CodeDifferences, ValuesComputedByHand) {
    const std::vector<std::uint8_t> a = {0, 10, 20, 255, 30, 40, 50, 255, 7, 7, 7, 0};
    const std::vector<std::uint8_t> b = {0, 11, 20, 0, 30, 36, 51, 0, 7, 7, 7, 255};
    const CodeDifferences d = compare_codes({3, 1, a}, {3, 1, b});
    EXPECT_EQ(d.difference.max, 4.0);
    EXPECT_EQ(d.difference.x, 1);
    EXPECT_EQ(d.difference.channel, 1);
    EXPECT_DOUBLE_EQ(d.difference.mean, 6.0 / 9.0);
    EXPECT_EQ(d.pixels, 3u);
    EXPECT_EQ(d.different_pixels, 2u);
}

}  // namespace
}  // namespace kilolux
