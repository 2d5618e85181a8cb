// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/shadow_error.h"

#include <gtest/gtest.h>

#include "host/certify/shadow_scenarios.h"
#include "host/measure/metrics/statistics.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

std::vector<SampledShadowError> measure(const ShadowScenario& scenario,
                                        const ShadowErrorPlan& plan) {
    const ReportView view{scenario.scene, scenario.camera, 0.0};
    return measure_shadow_error(view, small_settings(48, 27, 0), plan, [] {});
}

// Columns between a floor and lamps.
ShadowScenario lit_columns() {
    ShadowScenario out = columns_scenario();
    for (int i = 0; i < 9; ++i) {
        out.scene.lights.push_back(lamp({1.7 * i - 7.0, 1.0 + 0.4 * i, -4.0 + i}));
    }
    return out;
}

TEST(ShadowError, AnIntervalIsOfTheStandardError) {
    EXPECT_TRUE(is_within(1.0, 0.04, 1.39));
    EXPECT_TRUE(is_within(1.0, 0.04, 0.61));
    EXPECT_FALSE(is_within(1.0, 0.04, 1.40));
    EXPECT_TRUE(is_within(1.0, 0.0, 1.0));
    EXPECT_FALSE(is_within(1.0, 0.0, 1.001));
}

// Few lights: with many rays nearly all are drawn, and little variance is left.
TEST(ShadowError, FallsWithTheRaysAndIsTold) {
    const auto errors = measure(lit_columns(), {.rays = {1, 4, 1000}, .draws = 400, .seeds = 2});
    ASSERT_EQ(errors.size(), 3u);
    EXPECT_EQ(errors[0].seeds, 400);
    EXPECT_EQ(errors[1].seeds, 100);
    EXPECT_EQ(errors[2].seeds, 2);
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
        const SampledShadowError& e = errors[i];
        EXPECT_GT(e.rmse, 0.0) << e.rays;
        EXPECT_NEAR(e.estimated_variance / e.variance, 1.0, 0.15) << e.rays;
        EXPECT_GT(e.noisy_share, 0.05) << e.rays;
        EXPECT_LT(e.noisy_share, 0.95) << e.rays << ": no shadow falls there";
        EXPECT_LE(e.tested_share, e.noisy_share) << e.rays;
    }
    EXPECT_LT(4.0 * errors[1].variance, 1.3 * errors[0].variance) << "1/N or less";
    EXPECT_GT(errors[0].tested_share, 0.02);
    EXPECT_NEAR(errors[0].within_mean, 0.95, 0.03) << "of tested pixels";
    EXPECT_LT(errors[0].within_picture, 0.9) << "one ray estimates a pixel badly";
    EXPECT_LT(errors[2].variance, 1e-4 * errors[0].variance);
    EXPECT_LT(errors[2].noisy_share, 0.01);
}

// The truth is a mean of pictures, whose noise is part of each interval.
TEST(ShadowError, OfLightsWithASizeIsAboutTheMean) {
    ShadowScenario scenario = lit_columns();
    for (SceneLight& light : scenario.scene.lights) {
        light.type = LightType::sphere;
        light.radius = 0.4f;
    }
    const auto errors =
        measure(scenario,
                {.rays = {4, 16}, .draws = 512, .seeds = 2, .truth = {.rays = 64, .pictures = 32}});
    for (const SampledShadowError& e : errors) {
        EXPECT_NEAR(e.estimated_variance / e.variance, 1.0, 0.15) << e.rays;
        EXPECT_GT(e.tested_share, 0.02) << e.rays;
        EXPECT_NEAR(e.within_mean, 0.95, 0.03) << e.rays;
    }
    EXPECT_LT(4.0 * errors[1].variance, 1.3 * errors[0].variance) << "1/N or less";
}

TEST(ShadowError, IsNoneWhereNothingHides) {
    const auto errors = measure(grazing_scenario(), {.rays = {1}, .draws = 8, .seeds = 4});
    EXPECT_EQ(errors.front().seeds, 8);
    EXPECT_EQ(errors.front().rmse, 0.0);
    EXPECT_EQ(errors.front().estimated_variance, 0.0);
    EXPECT_EQ(errors.front().noisy_share, 0.0);
}

TEST(ShadowError, TablesAndPlotsHaveARowForEachNumberOfRays) {
    std::vector<SampledShadowError> errors(2);
    errors[0] = {.rays = 2, .seeds = 8, .variance = 0.5, .estimated_variance = 0.4};
    errors[1] = {.rays = 8, .seeds = 8, .variance = 0.1, .estimated_variance = 0.1};
    const Table table = shadow_error_table(errors);
    ASSERT_EQ(table.rows.size(), 2u);
    EXPECT_EQ(table.columns.front(), "rays N");
    EXPECT_EQ(std::get<double>(table.rows[0][4]), 1.0) << "N x variance";
    EXPECT_TRUE(std::holds_alternative<std::monostate>(table.rows[0].back())) << "none is tested";
    const Plot plot = shadow_error_plot(errors, "here");
    ASSERT_EQ(plot.series.size(), 3u);
    EXPECT_EQ(plot.series[0].points[1].y, 0.1);
    EXPECT_EQ(plot.series[2].points[1].y, 0.125) << "a quarter of the first";
}

}  // namespace
}  // namespace kilolux
