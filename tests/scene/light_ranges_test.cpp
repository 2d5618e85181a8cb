// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/light_ranges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/base/error.h"
#include "host/scene/lights/bounded_loss.h"
#include "tests/support/box_scene.h"

namespace kilolux {
namespace {

// Radiance of a white Lambert surface that faces the light.
double unwindowed(double intensity, double d) { return intensity / (M_PI * d * d); }

double windowed(double intensity, double d, double range) {
    return unwindowed(intensity, d) * std::clamp(1.0 - std::pow(d / range, 4.0), 0.0, 1.0);
}

TEST(LightRanges, ErrorIsNowhereAboveTheBudget) {
    for (const double intensity : {1e-3, 1.0, 54.35, 1e6}) {
        for (const double budget : {kDefaultRangeBudget, 0.1, 1e-5}) {
            const double range = range_of_light(intensity, budget);
            EXPECT_NEAR(unwindowed(intensity, range), budget, 1e-12 * budget);
            double worst = 0.0;
            for (double x = 0.001; x < 3.0; x += 0.001) {
                const double d = x * range;
                worst = std::max(worst, unwindowed(intensity, d) - windowed(intensity, d, range));
            }
            EXPECT_LE(worst, budget * (1 + 1e-9)) << intensity << " cd, budget " << budget;
            EXPECT_GE(worst, budget * 0.99) << intensity << " cd, budget " << budget;
        }
    }
}

TEST(LightRanges, DarkLightReachesNothing) { EXPECT_EQ(range_of_light(0.0), 0.0); }

TEST(LightRanges, FillsOnlyWhatIsMissing) {
    std::vector<SceneLight> lights(4);
    lights[0].intensity = {1.0f, 20.0f, 3.0f};
    lights[1].range = 5.0f;
    lights[2].type = LightType::directional;
    lights[3].type = LightType::spot;
    fill_missing_ranges(lights, Tails::bounded);
    EXPECT_FLOAT_EQ(lights[0].range, static_cast<float>(range_of_light(20.0)));
    EXPECT_EQ(lights[1].range, 5.0f);
    EXPECT_EQ(lights[2].range, 0.0f);
    EXPECT_FLOAT_EQ(lights[3].range, static_cast<float>(range_of_light(1.0)));
}

TEST(LightRanges, LeavesUnusableLightsToBeRejected) {
    std::vector<SceneLight> lights(4);
    lights[0].range = -1.0f;
    lights[1].range = std::nanf("");
    lights[2].intensity.y = std::nanf("");
    lights[3].intensity.z = -1.0f;
    EXPECT_TRUE(std::ranges::none_of(lights, lacks_range));
    fill_missing_ranges(lights, Tails::bounded);
    EXPECT_EQ(lights[0].range, -1.0f);
    EXPECT_TRUE(std::isnan(lights[1].range));
    EXPECT_EQ(lights[2].range, 0.0f);
    EXPECT_EQ(lights[3].range, 0.0f);
}

TEST(LightRanges, ExactOnesReachEverywhere) {
    std::vector<SceneLight> lights(2);
    lights[1].range = 5.0f;
    fill_missing_ranges(lights, Tails::exact);
    EXPECT_EQ(lights[0].range, kUnlimitedRange);
    EXPECT_EQ(lights[1].range, 5.0f);
}

TEST(LightRanges, ManyFarLightsLoseMostOfTheirLight) {
    Scene scene = box_scene({80.0, 4.0, 400.0});
    for (int i = 0; i < 129; ++i) {
        SceneLight light;
        light.position = {i % 8 * 10.0 - 35.0, 20.0, i / 8 * 24.0 - 190.0};
        light.intensity = glm::vec3(1.2f);
        scene.lights.push_back(light);
    }
    EXPECT_GT(bounded_loss(scene.lights, resting_bounds(scene)), 0.5);
    for (SceneLight& light : scene.lights) light.intensity *= 1e6f;
    EXPECT_LT(bounded_loss(scene.lights, resting_bounds(scene)), 0.01) << "ranges beyond the scene";
    for (SceneLight& light : scene.lights) light.range = 1.0f;
    EXPECT_EQ(bounded_loss(scene.lights, resting_bounds(scene)), 0.0) << "they have their own";
}

TEST(LightRanges, AutomaticIsExactForFewAndHeedsABudget) {
    std::vector<SceneLight> lights(kExactTails);
    lights.push_back({.range = 5.0f});
    lights.push_back({.type = LightType::directional});
    const auto chosen = [&](double budget) { return tails_for(lights, Tails::automatic, budget); };
    EXPECT_EQ(chosen(kDefaultRangeBudget), Tails::exact);
    EXPECT_EQ(chosen(0.01), Tails::bounded);
    EXPECT_EQ(tails_for(lights, Tails::bounded, kDefaultRangeBudget), Tails::bounded);
    lights.emplace_back();
    EXPECT_EQ(chosen(kDefaultRangeBudget), Tails::bounded);
    EXPECT_EQ(tails_for(lights, Tails::exact, 0.01), Tails::exact);
}

TEST(LightRanges, RefusesNonsense) {
    EXPECT_THROW(range_of_light(-1.0), Error);
    EXPECT_THROW(range_of_light(std::nan("")), Error);
    EXPECT_THROW(range_of_light(1.0, 0.0), Error);
    EXPECT_THROW(range_of_light(1.0, HUGE_VAL), Error);
}

}  // namespace
}  // namespace kilolux
