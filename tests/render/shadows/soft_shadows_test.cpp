// SPDX-License-Identifier: Apache-2.0
// Sampled shadows of lights with a size, against a quadrature in double.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "host/base/error.h"
#include "host/scene/generated/mesh_builder.h"
#include "host/scene/generated/small.h"
#include "tests/render/shadows/seen_shares.h"
#include "tests/render/shadows/soft_scenes.h"

namespace kilolux {
namespace {

// Whole light has no noise at all, and a full shadow is black but for the rounding of the
// difference from the unshadowed light.
void expect_exact_where_nothing_is_partial(const SharePixel& pixel) {
    if (pixel.truth == 0.0) {
        EXPECT_LT(std::abs(pixel.mean), 0x1p-18) << pixel.index;
    } else if (pixel.truth == 1.0) {
        EXPECT_EQ(pixel.estimated, 0.0) << pixel.index;
    }
}

TEST(SoftShadows, AreInTheMeanTheShareOfAQuadrature) {
    for (const LightType type : kSizedTypes) {
        SCOPED_TRACE(static_cast<int>(type));
        const SharePixels found = seen_shares(board_below(panel(type)), soft_settings(), 120);
        double squares = 0.0;
        int partial = 0, dark = 0;
        for (const SharePixel& pixel : found.pixels) {
            dark += pixel.truth == 0.0 ? 1 : 0;
            if (!pixel.is_edge) expect_exact_where_nothing_is_partial(pixel);
            if (pixel.truth < 0.05 || pixel.truth > 0.95) continue;
            ++partial;
            const double error = std::sqrt(pixel.estimated / found.pictures);
            squares += std::pow((pixel.mean - pixel.truth) / error, 2.0);
            EXPECT_LT(std::abs(pixel.mean - pixel.truth), 5.0 * error + 0.004) << pixel.index;
        }
        EXPECT_GT(partial, 40);
        EXPECT_GT(dark, 10);
        // Pixels of a tile err together: of 1 by half of it.
        EXPECT_NEAR(squares / partial, 1.0, 0.6);
    }
}

// The glossy lobe's share is that of a linearly transformed cosine, within 0.4 % of the true one.
TEST(SoftShadows, OfGlossyMetalAreThoseOfItsLobe) {
    ShadowScenario scenario = board_below(panel(LightType::rectangle));
    scenario.scene.materials.front().metallic = 1.0f;
    scenario.scene.materials.front().roughness = 0.35f;
    scenario.camera = look_at({0.5, 4.0, 3.5}, {0.1, 0.0, 0.2}, {0, 1, 0}, 0.9);
    RenderSettings settings = soft_settings(48, 27, 16);
    settings.shading = Shading::pbr;
    const SharePixels found = seen_shares(scenario, settings, 60);
    double squares = 0.0, diffuse = 0.0;
    int partial = 0;
    for (const SharePixel& pixel : found.pixels) {
        if (!pixel.is_edge) expect_exact_where_nothing_is_partial(pixel);
        if (pixel.truth < 0.05 || pixel.truth > 0.95) continue;
        ++partial;
        squares += std::pow(pixel.mean - pixel.truth, 2.0);
        diffuse += std::pow(pixel.diffuse_truth - pixel.truth, 2.0);
    }
    ASSERT_GT(partial, 40);
    EXPECT_LT(std::sqrt(squares / partial), 0.03);
    EXPECT_GT(std::sqrt(diffuse / partial), 0.06) << "the diffuse share would do";
}

// Means of batches of pictures: with few pictures an estimated variance is noisy itself.
TEST(SoftShadows, IntervalsHoldTheTruth) {
    const SharePixels found =
        seen_shares(board_below(panel(LightType::rectangle)), soft_settings(), 3000, 100);
    double within = 0.0, all = 0.0, actual = 0.0, estimated = 0.0;
    for (const SharePixel& pixel : found.pixels) {
        if (pixel.truth < 0.1 || pixel.truth > 0.9) continue;  // too few rays of one kind
        within += pixel.batches_within;
        all += found.batches;
        actual += pixel.variance;
        estimated += pixel.estimated;
    }
    ASSERT_GT(all, 1000.0);
    EXPECT_NEAR(within / all, 0.95, 0.015);
    EXPECT_NEAR(estimated / actual, 1.0, 0.05);
}

TEST(SoftShadows, ErrorsFallWithTheRays) {
    const ShadowScenario scenario = board_below(panel(LightType::rectangle));
    double before = 0.0;
    for (const int rays : {2, 8, 32}) {
        const SharePixels found = seen_shares(scenario, soft_settings(48, 27, rays), 100);
        const double variance =
            std::accumulate(found.pixels.begin(), found.pixels.end(), 0.0,
                            [](double sum, const SharePixel& p) { return sum + p.variance; });
        if (before > 0.0) {
            EXPECT_LT(4.0 * variance, 1.1 * before) << rays << ": 1 / N or less";
        }
        before = variance;
    }
}

// The bits of a picture without shadows, and no noise.
void expect_unshadowed(const ShadowScenario& scenario, RenderSettings settings) {
    settings.want.aovs = {"error-standard"};
    const Frame sampled = Renderer(scenario.scene, settings).render(scenario.camera, 0.0);
    settings.want.aovs.clear();
    settings.shadows = Shadows::off;
    EXPECT_EQ(sampled.radiance,
              Renderer(scenario.scene, settings).render(scenario.camera, 0.0).radiance);
    for (const float error : sampled.aovs.front().values) ASSERT_EQ(error, 0.0f);
}

TEST(SoftShadows, WithoutCastersAreNoNoise) {
    for (const LightType type : kSizedTypes) {
        ShadowScenario scenario = board_below(panel(type));
        scenario.scene.instances.pop_back();
        expect_unshadowed(scenario, soft_settings());
    }
}

// A bulb in its light, as of glass around a filament. The floor reflects it glossily, too.
TEST(SoftShadows, WhatASphereEnclosesHidesNothingOfIt) {
    const SceneLight light = panel(LightType::sphere);
    ShadowScenario scenario = board_below(light);
    scenario.scene.instances.pop_back();
    scenario.scene.materials.front().roughness = 0.3f;
    const int bulb =
        add_mesh(scenario.scene, ball(0.97 * light.radius, 24).build("bulb", 0, 1.0, false));
    place(scenario.scene, bulb, placed(light.position));
    RenderSettings settings = soft_settings(48, 27, 16);
    settings.shading = Shading::pbr;
    expect_unshadowed(scenario, settings);
}

// The edge of a board at height h under a light of width w at height H casts a penumbra of the
// width w h / (H - h).
TEST(SoftShadows, PenumbraeAreAsWideAsSimilarTriangles) {
    constexpr double kEdge = 1.0, kHeight = 4.0, kWidth = 1.5;
    Scene scene = shadow_stage();
    add_box(scene, {20.0, 0.5, 20.0}, {0.0, -0.25, 0.0});
    add_box(scene, {6.0, 1e-3, 20.0}, {-3.0, kEdge, 0.0});
    SceneLight light = panel(LightType::rectangle);
    light.side = {1.0, 0.0, 0.0};
    light.width = static_cast<float>(kWidth);
    scene.lights.push_back(light);
    const ShadowScenario scenario = {"edge", scene,
                                     look_at({3.0, 0.8, 0.0}, {0.0, 0.0, 0.0}, {0, 1, 0}, 0.7)};
    const SharePixels found = seen_shares(scenario, soft_settings(96, 54, 32), 4);
    const double half_width = 0.5 * kWidth * kEdge / (kHeight - kEdge);
    int dark = 0, partial = 0, lit = 0;
    for (const SharePixel& pixel : found.pixels) {
        const double x = pixel.position.x / half_width;
        if (std::abs(pixel.position.y) > 0.1 || std::abs(pixel.position.z) > 2.0) continue;
        if (pixel.position.x < -4.0) continue;  // beyond the board's other edge
        if (x < -1.02) {
            EXPECT_LT(std::abs(pixel.mean), 0x1p-18) << x;
        } else if (x > 1.02) {
            EXPECT_NEAR(pixel.mean, 1.0, 0x1p-18) << x;
        } else if (std::abs(x) < 0.8) {
            EXPECT_GT(pixel.mean, 0.01) << x;
            EXPECT_LT(pixel.mean, 0.99) << x;
        }
        dark += x < -1.02 ? 1 : 0;
        lit += x > 1.02 ? 1 : 0;
        partial += std::abs(x) < 0.8 ? 1 : 0;
    }
    EXPECT_GT(dark, 50);
    EXPECT_GT(partial, 50);
    EXPECT_GT(lit, 50);
}

TEST(SoftShadows, NoLightComesThroughAWallOfAMillimetre) {
    ShadowScenario scenario = thin_wall_scenario();
    SceneLight light = panel(LightType::rectangle);
    light.position = {0.3, 3.0, -1.2};
    light.width = 1.5f;
    scenario.scene.lights = {light};
    RenderSettings settings = soft_settings(96, 54, 8);
    const Frame sampled = Renderer(scenario.scene, settings).render(scenario.camera, 0.0);
    settings.shadows = Shadows::off;
    Renderer off(scenario.scene, settings);
    const Frame whole = off.render(scenario.camera, 0.0);
    const SurfaceSamples surfaces = surface_samples(off.lit_surfaces().surfaces);
    int lit = 0;
    for (std::size_t i = 0; i < surfaces.pixels.size(); ++i) {
        if (surfaces.pixels[i].kind == SurfaceKind::background) continue;
        if (world_of(scenario.camera, surfaces.pixels[i].position).z < 0.01) continue;
        const float all = luminance_of(whole.radiance, i);
        lit += all > 0.0f ? 1 : 0;
        EXPECT_LE(std::abs(luminance_of(sampled.radiance, i)), 0x1p-18f * all) << i;
    }
    EXPECT_GT(lit, 500);
}

TEST(SoftShadows, ExactOnesAreRefused) {
    RenderSettings settings = soft_settings();
    settings.shadows = Shadows::exact;
    for (const LightType type : kSizedTypes) {
        expect_refused(board_below(panel(type)).scene, settings, "--shadows sampled");
    }
}

}  // namespace
}  // namespace kilolux
