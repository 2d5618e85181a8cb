// SPDX-License-Identifier: Apache-2.0
// Means of as many pictures as tiles need: unbiased for any spread of the light, variances against
// float64, and tiles that are done.
#include "host/stages/picture/adaptive_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "host/certify/synthetic/synthetic.h"
#include "host/stages/lists/mask_tiles.h"
#include "tests/support/full.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

constexpr float kFloor = 0.1f;

View view_with(uint width, uint height) {
    ViewShape shape;
    shape.width = width;
    shape.height = height;
    return make_view(shape);
}

std::size_t size_of(const View& view) { return std::size_t{view.stride} * view.height; }

// Light of a picture's pixel, the same in all channels.
using PixelLight = std::function<float(uint x, uint y)>;

// Adds pictures to the stage and keeps its results.
struct Feed {
    Gpu gpu;
    View view;
    AdaptiveSamples samples{gpu, default_tuning(gpu.info)};
    StageTimer timer{};
    uint groups = 0;  // the g-th has g + 2 times the picture's light

    void add(uint half, const PixelLight& light) {
        Radiance radiance{{}, view, groups};
        std::vector<float> planes(radiance.floats());
        for (uint y = 0; y < view.height; ++y) {
            for (uint x = 0; x < view.width; ++x) {
                const std::size_t i = std::size_t{y} * view.stride + x;
                const float value = light(x, y);
                for (uint plane = 0; plane < radiance.plane_count(); ++plane) {
                    planes[plane * size_of(view) + i] = value * static_cast<float>(1 + plane / 3);
                }
            }
        }
        radiance.planes = new_buffer(gpu, planes);
        samples.add(half, radiance, timer);
    }

    // Rounds of four pictures of each half, until all tiles are done or there are `most`.
    void run(float error, int most, const PixelLight& light) {
        for (int taken = 0; taken < most; taken += 4) {
            for (uint half = 0; half < 2; ++half) {
                for (int i = 0; i < 4; ++i) add(half, light);
            }
            samples.decide(error, kFloor, timer);
            if (open() == 0) return;
        }
    }

    std::ptrdiff_t open() const { return std::ranges::count(samples.open_tiles(), true); }

    std::vector<float> mean() {
        const Radiance radiance = samples.mean(timer);
        return download<float>(gpu, radiance.planes, radiance.floats());
    }
};

TEST(AdaptiveSamples, StillLightNeedsTheLeastAndKeepsItsBits) {
    for (const int lanes : lane_widths()) {
        Feed feed{test_gpu(lanes), view_with(53, 41)};
        feed.groups = lanes == lane_widths().front() ? 0 : 2;
        const PixelLight light = [](uint x, uint y) {
            return 0.1f * static_cast<float>(x) / static_cast<float>(y + 1);
        };
        feed.run(1e-6f, 64, light);
        EXPECT_EQ(feed.open(), 0);
        EXPECT_EQ(feed.samples.tile_count(), 12u);
        const std::vector<float> mean = feed.mean();
        const std::vector<uint> taken = feed.samples.taken();
        const auto variance = download<float>(feed.gpu, feed.samples.variance());
        for (uint y = 0; y < 41; ++y) {
            for (uint x = 0; x < 53; ++x) {
                const std::size_t i = std::size_t{y} * feed.view.stride + x;
                for (uint group = 0; group <= feed.groups; ++group) {
                    const float expected = light(x, y) * static_cast<float>(1 + group);
                    ASSERT_EQ(mean[i + 3 * group * size_of(feed.view)], expected);
                    ASSERT_EQ(mean[i + (3 * group + 2) * size_of(feed.view)], expected);
                }
                ASSERT_EQ(taken[i], 8u);
                ASSERT_EQ(variance[i], 0.0f);
            }
        }
    }
}

// Rare, bright light: most tiles see none of it at first. A mean that stopped because its own
// samples agree would lose much of it.
TEST(AdaptiveSamples, RareLightIsRightOnAverage) {
    constexpr double kRare = 0.125;
    Feed feed{test_gpu(), view_with(512, 512)};
    Random random(7);
    double sum = 0.0, squares = 0.0, tiles = 0.0;
    std::vector<float> of_tile(32 * 32);
    for (int repeat = 0; repeat < 6; ++repeat) {
        feed.samples.clear();
        const PixelLight light = [&](uint x, uint y) {
            if (x == 0 && y == 0) {
                for (float& value : of_tile) {
                    value = random.unit() < kRare ? static_cast<float>(1.0 / kRare) : 0.0f;
                }
            }
            return of_tile[y / FINE_TILE * 32 + x / FINE_TILE];
        };
        feed.run(0.25f, 64, light);
        const std::vector<float> mean = feed.mean();
        for (uint y = 0; y < 512; y += FINE_TILE) {
            for (uint x = 0; x < 512; x += FINE_TILE) {
                const double value = mean[std::size_t{y} * feed.view.stride + x];
                sum += value;
                squares += value * value;
                tiles += 1.0;
            }
        }
    }
    const double average = sum / tiles;
    const double error = std::sqrt((squares / tiles - average * average) / tiles);
    EXPECT_LT(error, 0.02);
    EXPECT_NEAR(average, 1.0, 4.0 * error);
}

// Noise at every pixel: the estimated error is that of the mean, and tiles stop about where they
// reach the error asked for.
TEST(AdaptiveSamples, TilesEndWhereTheirErrorIsTheOneAskedFor) {
    constexpr double kError = 0.05;
    Feed feed{test_gpu(), view_with(128, 96)};
    Random random(9);
    // Uniform from 0 to 2 m: variance m^2 / 3, so the error is reached after 1 / (3 error^2)
    // samples, whatever m is where the floor is small.
    const auto middle = [](uint x) { return x < 64 ? 5.0 : 50.0; };
    feed.run(static_cast<float>(kError), 512, [&](uint x, uint) {
        return static_cast<float>(random.uniform(0.0, 2.0 * middle(x)));
    });
    EXPECT_EQ(feed.open(), 0);
    const std::vector<float> mean = feed.mean();
    const std::vector<uint> taken = feed.samples.taken();
    const auto variance = download<float>(feed.gpu, feed.samples.variance());
    double seen = 0.0, estimated = 0.0;
    for (uint y = 0; y < 96; ++y) {
        for (uint x = 0; x < 128; ++x) {
            const std::size_t i = std::size_t{y} * feed.view.stride + x;
            const double m = middle(x);
            seen += std::pow(mean[i] / m - 1.0, 2.0) / (128 * 96);
            estimated += variance[i] / (m * m) / (128 * 96);
            const double least = 1.0 / (3.0 * kError * kError);
            const double granted = 1.0 + std::sqrt(2.0 / (least / 2.0 - 1.0));
            ASSERT_GT(taken[i], 0.98 * least);
            ASSERT_LT(taken[i], 1.05 * granted * least + 8);
        }
    }
    EXPECT_NEAR(seen / estimated, 1.0, 0.06);
    EXPECT_LT(std::sqrt(seen), 1.02 * kError);
    EXPECT_GT(std::sqrt(seen), 0.85 * kError);
}

// Values 1 and 3 by turns: n samples of a half differ from their mean by n in all, so the estimated
// variance of both halves' mean is 1 / (2 (n - 1)), and as many degrees of freedom grant its error.
TEST(AdaptiveSamples, FewSamplesAreGrantedLess) {
    constexpr double kTaken = 4.0;
    const double variance = 1.0 / (2.0 * (kTaken - 1.0));
    const double granted = 1.0 + std::sqrt(2.0 / (kTaken - 1.0));
    const double limit = std::sqrt(variance * granted / (4.0 + kFloor * kFloor));
    for (const double share : {0.999, 1.001}) {
        Feed feed{test_gpu(), view_with(16, 16)};
        int values = 0;
        feed.run(static_cast<float>(share * limit), 4, [&](uint x, uint y) {
            if (x == 0 && y == 0) ++values;
            return values % 2 == 0 ? 1.0f : 3.0f;
        });
        EXPECT_EQ(feed.open(), share < 1.0 ? 1 : 0) << share;
    }
}

TEST(AdaptiveSamples, TilesThatNeverAgreeTakeTheMostAndAreTold) {
    Feed feed{test_gpu(), view_with(48, 16)};
    Random random(5);
    const float infinite = std::numeric_limits<float>::infinity();
    // Still, noisy, and infinite at a pixel of still light.
    feed.run(0.001f, 32, [&](uint x, uint y) {
        if (x < 16) return 1.0f;
        if (x < 32) return static_cast<float>(random.unit());
        return x == 40 && y == 8 ? infinite : 2.0f;
    });
    EXPECT_EQ(feed.open(), 1);
    const std::vector<float> mean = feed.mean();
    const std::vector<uint> taken = feed.samples.taken();
    EXPECT_EQ(taken[0], 8u);
    EXPECT_EQ(taken[20], 64u);
    EXPECT_EQ(taken[40], 8u);
    const std::size_t row = 8 * std::size_t{feed.view.stride};
    EXPECT_EQ(mean[row + 40], infinite);
    EXPECT_EQ(mean[row + 41], 2.0f);
    // Pixels beyond the infinite pixel's tile are not affected by it.
    EXPECT_NEAR(mean[row + 20], 0.5f, 0.2f);
}

TEST(MaskTiles, EmptiesTheTilesOfWhichBothMeansHaveEnded) {
    for (const int lanes : {1, 8}) {
        const Gpu gpu = test_gpu(lanes);
        const View view = view_with(40, 20);  // 3 x 2 tiles
        const std::vector<uint> fixed = {4, 0, 4, 6, 0, 9, /**/ 4, 6, 0, 4, 0, 4};
        const std::vector<bool> empty = {true, false, false, true, false, true};
        std::vector<uint> ids(size_of(view));
        for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = static_cast<uint>(i + 1);
        MaskTiles mask(gpu, default_tuning(gpu.info));
        StageTimer timer;
        const auto masked = download<uint>(
            gpu, mask.enqueue({new_buffer(gpu, fixed)}, view, new_buffer(gpu, ids), timer));
        for (uint y = 0; y < view.height; ++y) {
            for (uint x = 0; x < view.width; ++x) {
                const std::size_t i = std::size_t{y} * view.stride + x;
                ASSERT_EQ(masked[i], empty[fine_tile_of(view, x, y)] ? 0u : ids[i])
                    << x << "," << y;
            }
        }
    }
}

}  // namespace
}  // namespace kilolux
