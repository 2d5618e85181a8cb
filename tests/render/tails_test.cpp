// SPDX-License-Identifier: Apache-2.0
// Lights without a range: exact, bounded with a bound of the loss, and stochastic with its error.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/base/error.h"
#include "host/certify/tail_scenarios.h"
#include "host/measure/metrics/statistics.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

constexpr int kWidth = 48;
constexpr int kHeight = 27;
constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

// The grid with every kind of light, and `count` more that have no range.
Scene scene_without_ranges(int count) {
    Scene scene = grid_with_every_light();
    const Box box = bounds(scene);
    for (int i = 0; i < count; ++i) {
        const double t = (i + 0.5) / count;
        SceneLight light;
        light.type = i % 3 == 0 ? LightType::spot : LightType::point;
        light.position = {box.min.x + t * box.size().x, box.max.y + 0.3 + std::fmod(7.0 * t, 2.0),
                          box.min.z + std::fmod(5.0 * t, 1.0) * box.size().z};
        light.direction = glm::normalize(glm::dvec3(0.3, -1.0, 0.2));
        light.intensity = {1.0f + static_cast<float>(i % 5), 3.0f, 2.0f};
        light.inner_cone = 0.3f;
        light.outer_cone = 0.9f;
        scene.lights.push_back(light);
    }
    return scene;
}

RenderSettings tail_settings(Tails tails) {
    RenderSettings settings = small_settings(kWidth, kHeight, 0);
    settings.tails = tails;
    settings.range_budget = 0.05;
    return settings;
}

TEST(Tails, ExactOnesAreTheUnlimitedLights) {
    const Scene scene = scene_without_ranges(40);
    const TailAgreement found =
        compare_tails({"", scene, first_camera(scene)}, tail_settings(Tails::exact));
    EXPECT_GT(found.values, 1000);
    EXPECT_LE(found.largest_error, 1e-5);
}

TEST(Tails, AreTheSameBitsHoweverTheyAreMade) {
    const Scene scene = scene_without_ranges(300);
    for (const Tails tails : {Tails::exact, Tails::bounded, Tails::stochastic}) {
        RenderSettings settings = tail_settings(tails);
        settings.lights.count = 50;
        settings.samples = 2;
        const Frame listed = render_once(scene, settings);
        const auto expect_same = [&](const char* what) {
            EXPECT_EQ(render_once(scene, settings).radiance, listed.radiance) << what;
        };
        settings.band_rows = 16;
        expect_same("bands");
        settings.band_rows = 0;
        settings.grid = {5, 3, 2, 2};
        expect_same("grid");
        settings.kernels.lanes = 4;
        expect_same("lanes");
        settings.renderer = RendererKind::deferred_all;
        expect_same("all lights");
        settings.seed = 2;
        const bool drawn = tails == Tails::stochastic;
        EXPECT_EQ(render_once(scene, settings).radiance != listed.radiance, drawn);
    }
}

// Lights with a range of their own keep their bits.
TEST(Tails, LeaveLightsWithRangesAlone) {
    const Scene scene = grid_with_every_light();
    RenderSettings settings = tail_settings(Tails::exact);
    settings.lights.count = 100;
    const Frame exact = render_once(scene, settings);
    for (const Tails tails : {Tails::bounded, Tails::stochastic, Tails::tree, Tails::automatic}) {
        settings.tails = tails;
        EXPECT_EQ(render_once(scene, settings).radiance, exact.radiance);
    }
}

// Compares every pixel's bound with its loss.
TailAgreement check_bound(Shading shading, double budget) {
    const Scene scene = scene_without_ranges(60);
    RenderSettings settings = tail_settings(Tails::bounded);
    settings.range_budget = budget;
    settings.shading = shading;
    settings.gbuffer = GBUFFER_FULL;
    settings.width = 160;  // clusters of a tenth of the picture
    settings.height = 90;
    return compare_tails({"", scene, first_camera(scene)}, settings);
}

TEST(Tails, ABoundIsNeverBelowTheError) {
    for (const double budget : {0.3, 0.05, 0.004}) {
        for (const Shading shading : {Shading::lambert, Shading::blinn_phong, Shading::pbr}) {
            TailAgreement found = check_bound(shading, budget);
            EXPECT_EQ(found.below, 0) << budget;
            ASSERT_GT(found.looseness.size(), 500u) << budget;
            if (shading != Shading::lambert) continue;
            std::ranges::sort(found.looseness);
            EXPECT_LE(quantile(found.looseness, 0.5), 4.0) << budget;
        }
    }
}

// A wall that is seen at an angle, and lamps straight before it: the bound needs the products of
// the directions' components, whose signs the wall's normal has.
Scene lamps_before_a_wall(const glm::dvec3& normal) {
    Scene scene;
    scene.materials.push_back({});
    Mesh wall;
    const glm::dvec3 u = glm::normalize(glm::cross(normal, glm::dvec3(0.31, 0.52, -0.8)));
    const glm::dvec3 v = glm::cross(normal, u);
    for (const auto& [a, b] : {std::array{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}) {
        wall.positions.emplace_back(3.0 * (a * u + b * v));
        wall.normals.emplace_back(normal);
    }
    wall.indices = {0, 1, 2, 0, 2, 3};
    scene.meshes.push_back(wall);
    scene.instances.push_back({0, glm::dmat4(1.0)});
    for (int i = 0; i < 20; ++i) {
        SceneLight lamp;
        lamp.position = (40.0 + i) * normal;
        lamp.intensity = {3.0f, 2.0f, 1.0f};
        scene.lights.push_back(lamp);
    }
    return scene;
}

TEST(Tails, ABoundHoldsForEveryDirectionOfLight) {
    RenderSettings settings = tail_settings(Tails::bounded);
    settings.range_budget = 1.0;
    settings.shading = Shading::lambert;
    settings.gbuffer = GBUFFER_FULL;
    settings.grid.tiles_x = settings.grid.tiles_y = 16;
    const Camera camera = look_at({0, 0, 9}, {0, 0, 0}, {0, 1, 0}, 0.5);
    for (const glm::dvec3& towards : {glm::dvec3(1, 1, 0.3),
                                      {-1, 1, 0.3},
                                      {1, 0.1, 1},
                                      {-1, 0.1, 1},
                                      {0.1, 1, 1},
                                      {0.1, -1, 1}}) {
        const TailAgreement found =
            compare_tails({"", lamps_before_a_wall(glm::normalize(towards)), camera}, settings);
        EXPECT_EQ(found.below, 0) << towards.x << ' ' << towards.y;
        EXPECT_GT(found.looseness.size(), 300u) << towards.x << ' ' << towards.y;
    }
}

TEST(Tails, ABoundIsNothingWhereNothingIsLost) {
    RenderSettings settings = tail_settings(Tails::exact);
    settings.want.aovs = {"error-bound"};
    for (const int lanes : {1, 4, 8, 16}) {
        settings.kernels.lanes = lanes;
        const std::vector<float> bound =
            render_once(scene_without_ranges(5), settings).aovs.front().values;
        for (std::size_t i = 0; i < bound.size(); ++i) {
            EXPECT_EQ(bound[i], 0.0f) << "value " << i << ", lanes " << lanes;
        }
    }
}

// Over many seeds, since pixels share picks, so that their errors are correlated: each pixel's mean
// is the exact one within its own error, and estimated errors equal the actual ones.
void expect_right_in_the_mean(const Scene& scene, Shadows shadows, int seeds) {
    RenderSettings settings = tail_settings(Tails::exact);
    settings.shadows = shadows == Shadows::off ? Shadows::off : Shadows::exact;
    const Frame exact = render_once(scene, settings);
    settings.tails = Tails::stochastic;
    settings.range_budget = 0.3;
    settings.shadows = shadows;
    settings.want.aovs = {"error-standard"};
    Renderer renderer(scene, settings);
    std::vector<double> sum(kPixels), squares(kPixels), estimated(kPixels);
    for (int seed = 1; seed <= seeds; ++seed) {
        settings.seed = static_cast<uint>(seed);
        renderer.change(settings);
        const Frame frame = renderer.render(first_camera(scene), 0.0);
        for (std::size_t i = 0; i < kPixels; ++i) {
            const double off = luminance_of(frame.radiance, i) - luminance_of(exact.radiance, i);
            const double error = frame.aovs.front().values[i];
            sum[i] += off;
            squares[i] += off * off;
            estimated[i] += error * error;
        }
    }
    int noisy = 0, beyond = 0;
    double seen_variance = 0.0, estimated_variance = 0.0;
    for (std::size_t i = 0; i < kPixels; ++i) {
        const double mean = sum[i] / seeds;
        const double variance = squares[i] / seeds - mean * mean;
        if (variance < 1e-12) continue;
        ++noisy;
        beyond += std::abs(mean) > 3.0 * std::sqrt(variance / seeds) ? 1 : 0;
        seen_variance += variance;
        estimated_variance += estimated[i] / seeds;
    }
    EXPECT_GT(noisy, 500);
    EXPECT_LE(beyond, noisy / 50 + 2);
    EXPECT_NEAR(estimated_variance / seen_variance, 1.0, 0.1);
}

TEST(Tails, StochasticOnesAreRightInTheMeanAndTellTheirError) {
    expect_right_in_the_mean(scene_without_ranges(200), Shadows::off, 1600);
}

TEST(Tails, StochasticOnesWithShadowsHaveOneError) {
    expect_right_in_the_mean(scene_without_ranges(200), Shadows::exact, 300);
    expect_right_in_the_mean(scene_without_ranges(200), Shadows::sampled, 400);
}

TEST(Tails, ErrorsAreRefusedWhereThereAreNone) {
    RenderSettings settings = tail_settings(Tails::exact);
    settings.want.aovs = {"error-standard"};
    expect_refused(make_generated_scene("plain"), settings, "--tails stochastic");
    settings = tail_settings(Tails::stochastic);
    settings.want.aovs = {"error-bound"};
    expect_refused(make_generated_scene("plain"), settings, "error-standard");
    settings = tail_settings(Tails::bounded);
    settings.renderer = RendererKind::deferred_all;
    settings.want.aovs = {"error-bound"};
    expect_refused(make_generated_scene("plain"), settings, "--renderer deferred");
}

}  // namespace
}  // namespace kilolux
