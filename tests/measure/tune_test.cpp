// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/tune.h"

#include <gtest/gtest.h>
#include <map>

#include <random>

#include <algorithm>
#include <set>

#include "host/base/error.h"
#include "host/measure/bench/feature_cost.h"
#include "host/scene/generated/scenes.h"
#include "kernels/shared/evaluate_modes.h"
#include "tests/measure/test_device.h"
#include "tests/support/cache_sandbox.h"

namespace kilolux {
namespace {

// What it starts from is the built-in table's row.
using Tune = TuningSandbox;

DeviceInfo two_cores() { return device_named("test"); }

// The built-in row, but with 8 lanes, so that 16 is a change.
StoredTuning eight_lanes() {
    StoredTuning start = built_in_tuning(two_cores());
    start.lanes = 8;
    return start;
}

// A made-up device: best at 16 lanes, 4 rows and 32 chunks, and indifferent to the rest.
double made_up_ms(const StoredTuning& t) {
    const double lanes = t.lanes == 16 ? 1.0 : t.lanes == 8 ? 1.3 : 3.0;
    const double rows = t.tuning.shade_rows == 4 ? 1.0 : 1.2;
    const double chunks = t.tuning.cull_chunks == 32 ? 1.0 : 1.5;
    return 10.0 * lanes * rows * chunks;
}

// Whether every alternative that ran gave the start's picture.
bool same_pictures(const TuningResult& result) {
    return std::ranges::all_of(result.trials, &TuningTrial::same_picture);
}

TEST_F(Tune, FindsTheFastest) {
    const TuningResult result = tune(eight_lanes(), two_cores(), [](const StoredTuning& t) {
        return TuningMeasurement{made_up_ms(t), 1};
    });
    EXPECT_EQ(result.best.lanes, 16);
    EXPECT_EQ(result.best.tuning.shade_rows, 4);
    EXPECT_EQ(result.best.tuning.cull_chunks, 32);
    EXPECT_EQ(result.best.tuning.light_group, built_in_tuning(two_cores()).tuning.light_group)
        << "no gain, no change";
    EXPECT_DOUBLE_EQ(result.best_ms, 10.0);
    EXPECT_DOUBLE_EQ(result.start_ms, made_up_ms(result.start));
    EXPECT_TRUE(same_pictures(result));
}

TEST_F(Tune, KeepsTheIncumbentForLessThanTheGain) {
    const StoredTuning start = built_in_tuning(two_cores());
    const TuningResult result = tune(start, two_cores(), [&](const StoredTuning& t) {
        return TuningMeasurement{t == start ? 100.0 : 100.0 * (1.0 - 0.9 * kTuningGain), 1};
    });
    EXPECT_EQ(result.best, start);
    EXPECT_FALSE(result.trials.empty());
    for (const TuningTrial& trial : result.trials)
        EXPECT_FALSE(trial.accepted) << trial.parameter << " " << trial.value;
}

TEST_F(Tune, DoesNotTrustOneSlowRunOfTheStart) {
    const StoredTuning start = built_in_tuning(two_cores());
    int runs_of_start = 0;
    const TuningResult result = tune(start, two_cores(), [&](const StoredTuning& t) {
        const bool disturbed = t == start && runs_of_start++ == 0;
        return TuningMeasurement{disturbed ? 200.0 : 100.0, 1};
    });
    EXPECT_EQ(result.best, start);
    EXPECT_GE(runs_of_start, 2);
}

TEST_F(Tune, RefusesAnotherPicture) {
    const TuningResult result = tune(eight_lanes(), two_cores(), [](const StoredTuning& t) {
        return TuningMeasurement{made_up_ms(t), t.lanes == 16 ? 2u : 1u};
    });
    EXPECT_NE(result.best.lanes, 16);
    EXPECT_FALSE(same_pictures(result));
}

TEST_F(Tune, GoesOnWhereTheDeviceRefuses) {
    const TuningResult result = tune(eight_lanes(), two_cores(), [](const StoredTuning& t) {
        if (t.lanes == 16) throw Error("shade: out of resources");
        return TuningMeasurement{made_up_ms(t), 1};
    });
    EXPECT_EQ(result.best.lanes, 8);
    EXPECT_EQ(result.best.tuning.cull_chunks, 32);
    bool reported = false;
    for (const TuningTrial& trial : result.trials)
        reported = reported || trial.error == "shade: out of resources";
    EXPECT_TRUE(reported);
}

TEST_F(Tune, EndsAtAnInterruption) {
    int runs = 0;
    EXPECT_THROW(tune(eight_lanes(), two_cores(),
                      [&](const StoredTuning&) {
                          if (++runs == 3) throw Interrupted();
                          return TuningMeasurement{1.0, 1};
                      }),
                 Interrupted);
    EXPECT_EQ(runs, 3);
}

TEST_F(Tune, TriesOnlyWhatIsValidAndNothingTwice) {
    for (const bool is_cpu : {true, false}) {
        DeviceInfo device = two_cores();
        device.is_cpu = is_cpu;
        device.lane_width = is_cpu ? 8 : 1;
        device.max_work_group = 256;
        const TuningResult result = tune(built_in_tuning(device), device, [](const StoredTuning&) {
            return TuningMeasurement{1.0, 1};
        });
        for (std::size_t i = 0; i < result.trials.size(); ++i) {
            EXPECT_TRUE(is_valid(result.trials[i].tuning, device))
                << result.trials[i].parameter << " " << result.trials[i].value;
            for (std::size_t j = 0; j < i; ++j)
                EXPECT_FALSE(result.trials[i].tuning == result.trials[j].tuning) << i << " " << j;
        }
        EXPECT_GT(result.trials.size(), 10u);
    }
}

RenderSettings small_frame() {
    RenderSettings settings;
    settings.width = 150;
    settings.height = 70;
    settings.lights.count = 300;
    return settings;
}

Camera camera_for(const Scene& scene) {
    return scene.cameras.empty() ? frame_box(bounds(scene)) : camera_of(scene.cameras.front());
}

TEST(TuningTrials, GiveTheSameBits) {
    const Scene scene = make_generated_scene("grid");
    RenderSettings settings = small_frame();
    settings.shading = Shading::lambert;  // whose kernels build fastest
    LightingBench bench(scene, settings, camera_for(scene));
    const TuningResult result = tune(bench, 1);
    EXPECT_TRUE(same_pictures(result));
    EXPECT_TRUE(is_valid(result.best, bench.device()));
    EXPECT_GT(result.start_ms, 0.0);
    std::set<std::string> parameters;
    for (const TuningTrial& trial : result.trials) {
        EXPECT_EQ(trial.error, "") << trial.parameter << " " << trial.value;
        parameters.insert(trial.parameter);
    }
    EXPECT_EQ(parameters.size(), bench.device().is_cpu ? 8u : 11u);
}

TEST(LightingBenchTest, CountsAsTheRendererDoes) {
    const Scene scene = make_generated_scene("grid");
    LightingBench bench(scene, small_frame(), camera_for(scene));
    const FrameStats stats = bench.run(bench.request()).stats;
    EXPECT_EQ(stats.lights_used, 300u);
    EXPECT_GT(stats.surface_pixels, 0u);
    EXPECT_LE(stats.surface_pixels, 150u * 70u);
    EXPECT_GT(stats.active_clusters, 0u);
    EXPECT_GE(stats.refine_tests, stats.refined_pairs);
    EXPECT_GT(stats.evaluations_per_pixel, 0.0);
    EXPECT_EQ(stats.stages.size(), 8u);
}

TEST(FeatureCosts, AreMeasurableAboveTheirNoiseOnly) {
    EXPECT_FALSE(estimate_cost({-24.0, 10.0, 3.0, -8.0, 1.0, 2.0, 5.0, 4.0, 6.0}).measurable());
    EXPECT_FALSE(estimate_cost({-3.0, -3.1, -2.9, -3.0, -3.0, -3.0, -3.0, -3.0, -3.0}).measurable())
        << "no cost is below 0";
    const CostEstimate cost = estimate_cost({3.0, 3.2, 2.9, 3.1, 9.0, -1.0, 3.3, 3.4, 3.05});
    EXPECT_TRUE(cost.measurable()) << "one outlier on each side";
    EXPECT_DOUBLE_EQ(cost.ms, 3.1);
    EXPECT_NEAR(cost.noise_ms(), 0.2, 1e-12);
}

// Differences of equal times: about 2 % of the estimates may find a measurable cost.
TEST(FeatureCosts, OfNoiseAreSeldomMeasurable) {
    std::mt19937 random(3);
    std::normal_distribution<double> noise;
    int found = 0;
    for (int i = 0; i < 2000; ++i) {
        std::vector<double> differences(kCostTurns);
        for (double& d : differences) d = noise(random);
        found += estimate_cost(differences).measurable();
    }
    EXPECT_LT(found, 2 * 0.02 * 2000);
    EXPECT_GT(found, 0);
}

TEST(FeatureCosts, NameEveryLeftOutFeature) {
    const std::map<std::string, int> bytes_of = {
        {"emissive", 4},  {"metallic", 4},   {"specular", 4},
        {"occlusion", 1}, {"clearcoat", 4},  {"coat-normals", 4},
        {"sheen", 4},     {"anisotropy", 4}, {"transmission", 4}};
    const Scene scene = make_generated_scene("plain");
    RenderSettings settings = small_frame();
    settings.shading = Shading::lambert;
    LightingBench bench(scene, settings, camera_for(scene));
    const std::vector<FeatureCost> costs = measure_feature_costs(bench, 1);
    const ScenePlan plan = bench.request().plan;
    ASSERT_EQ(costs.size(), plan.left_out.size() + 2) << "two shading models beside";
    for (std::size_t i = 0; i < plan.left_out.size(); ++i)
        EXPECT_EQ(costs[i].feature, plan.left_out[i]);
    for (const FeatureCost& cost : costs) {
        EXPECT_NE(cost.measured, !cost.why.empty()) << cost.feature;
        const auto bytes = bytes_of.find(cost.feature);
        EXPECT_EQ(cost.bytes_per_pixel, bytes == bytes_of.end() ? 0 : bytes->second)
            << cost.feature;
    }
}

TEST(ForcedFeatures, AreCompiledInAndChangeNoBit) {
    const Scene scene = make_generated_scene("plain");
    RenderSettings settings = small_frame();
    settings.shading = Shading::lambert;
    LightingBench bench(scene, settings, camera_for(scene));
    const std::uint64_t picture = bench.run(bench.request()).picture;
    for (const std::string& feature : forceable_features()) {
        if (feature == "blinn-phong" || feature == "pbr") continue;
        RenderSettings forced = settings;
        forced.force_features = {feature};
        LightingRequest request = bench.request();
        request.plan = make_scene_plan(scene, forced, 300);
        EXPECT_NE(request.plan.kernels, bench.request().plan.kernels) << feature;
        EXPECT_EQ(bench.run(request).picture, picture) << feature;
    }
}

TEST(ForcedFeatures, ShadingModelsChangeThePlan) {
    const Scene scene = make_generated_scene("plain");
    RenderSettings settings = small_frame();
    settings.force_features = {"pbr"};
    EXPECT_EQ(make_scene_plan(scene, settings, 1).kernels.shading, SHADING_PBR);
    settings.force_features = {"normal-maps"};
    EXPECT_THROW(make_scene_plan(scene, settings, 1), Error);
}

}  // namespace
}  // namespace kilolux
