// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "host/base/error.h"

namespace kilolux {
namespace {

// One pixel at 5 m that faces the camera.
SurfaceSamples wall_pixel() {
    SurfaceSamples out = make_surface_samples(1, 1);
    out.pixels[0].position = {0, 0, -5};
    out.pixels[0].albedo = {0.5, 0.25, 0.125};
    out.pixels[0].kind = SurfaceKind::lit;
    return out;
}

ReferenceLight light_at(glm::dvec3 position, double range) {
    ReferenceLight out;
    out.position = position;
    out.inv_range2 = 1.0 / (range * range);
    out.intensity = {10, 20, 30};
    return out;
}

std::vector<double> radiance(const SurfaceSamples& surfaces, const ReferenceLights& lights,
                             const ReferenceOptions& options = {}) {
    return shade_reference(surfaces, lights, options).radiance.rgb;
}

TEST(Reference, OneLightByHand) {
    const ReferenceLights lights{{light_at({0, 0, -3}, 4.0)}, {}};
    const double attenuation = (1 - std::pow(2.0 / 4.0, 4)) / 4.0;
    const ReferencePicture p = shade_reference(wall_pixel(), lights, {});
    EXPECT_DOUBLE_EQ(p.radiance.rgb[0], 0.5 / std::numbers::pi * 10 * attenuation);
    EXPECT_DOUBLE_EQ(p.radiance.rgb[1], 0.25 / std::numbers::pi * 20 * attenuation);
    EXPECT_DOUBLE_EQ(p.radiance.rgb[2], 0.125 / std::numbers::pi * 30 * attenuation);
    EXPECT_DOUBLE_EQ(p.scale.rgb[2], 30 * attenuation);
    EXPECT_EQ(p.lights_per_pixel, 1.0);
}

TEST(Reference, UnboundedInverseSquareHasNoRange) {
    const ReferenceLights lights{{light_at({0, 3, -1}, 4.0)}, {}};
    EXPECT_EQ(radiance(wall_pixel(), lights)[0], 0.0) << "5 m away, range 4 m";
    EXPECT_DOUBLE_EQ(radiance(wall_pixel(), lights, {.windowed = false})[0],
                     0.5 / std::numbers::pi * 10 / 25.0 * (4.0 / 5.0));
}

// A random range is negative: where the light would be below the budget, its draw outweighs that.
TEST(Reference, DrawnRangesWeighByTheChanceOfTheDraw) {
    ReferenceLight light = light_at({0, 0, -3}, 4.0);
    light.inv_range2 = -light.inv_range2;
    const ReferenceLights lights{{light}, {}};
    const double unbounded = 0.5 / std::numbers::pi * 10 / 4.0;  // 2 m away
    EXPECT_DOUBLE_EQ(radiance(wall_pixel(), lights, {.random_ranges = 7.0})[0], unbounded);
    EXPECT_DOUBLE_EQ(radiance(wall_pixel(), lights, {.random_ranges = 15.0})[0],
                     unbounded * 4.0 * 15.0 / 30.0);
    light.inv_range2 = -1.0;
    EXPECT_EQ(radiance(wall_pixel(), {{light}, {}}, {.random_ranges = 15.0})[0], 0.0) << "drawn";
}

TEST(Reference, LightAtTheSurfaceIsFinite) {
    for (const double d : {0.0, 1e-30, 1e-6, 0.005, 0.01}) {
        const ReferenceLights lights{{light_at({0, 0, -5 + d}, 4.0)}, {}};
        const double value = radiance(wall_pixel(), lights)[0];
        const double window = 1 - std::pow(d / 4, 4);
        const double expected = 0.5 / std::numbers::pi * 10 * window / 1e-4 * (d / 0.01);
        EXPECT_NEAR(value, expected, 1e-12 * expected + 1e-9 * (d > 0 && d < 1e-5)) << d;
    }
}

TEST(Reference, SpotConeBetweenItsAngles) {
    const double cos_in = std::cos(0.2), cos_out = std::cos(0.5);
    const auto at_angle = [&](double angle) {
        ReferenceLight light = light_at({0, 0, -3}, 4.0);
        light.axis = {std::sin(angle), 0, -std::cos(angle)};
        light.cos_out = cos_out;
        light.cone_scale = 1 / (cos_in - cos_out);
        return radiance(wall_pixel(), {{light}, {}})[0];
    };
    const double full = radiance(wall_pixel(), {{light_at({0, 0, -3}, 4.0)}, {}})[0];
    EXPECT_DOUBLE_EQ(at_angle(0.0), full);
    EXPECT_DOUBLE_EQ(at_angle(0.19), full);
    EXPECT_NEAR(at_angle(std::acos((cos_in + cos_out) / 2)), full / 4, 1e-12);
    EXPECT_EQ(at_angle(0.51), 0.0);
    EXPECT_EQ(at_angle(std::numbers::pi), 0.0);
}

TEST(Reference, DirectionalLightHasNoFalloff) {
    const ReferenceLights lights{{}, {{.to_light = {0, 0.6, 0.8}, .illuminance = {2, 2, 2}}}};
    EXPECT_DOUBLE_EQ(radiance(wall_pixel(), lights)[0], 0.5 / std::numbers::pi * 2 * 0.8);
    const ReferenceLights behind{{}, {{.to_light = {0, 0.6, -0.8}, .illuminance = {2, 2, 2}}}};
    EXPECT_EQ(radiance(wall_pixel(), behind)[0], 0.0);
    EXPECT_EQ(shade_reference(wall_pixel(), behind, {}).scale.rgb[0], 2.0) << "E has no cosine";
}

TEST(Reference, AmbientEmissiveAndKinds) {
    SurfaceSamples surfaces = make_surface_samples(3, 1);
    for (auto& p : surfaces.pixels) {
        p = wall_pixel().pixels[0];
        p.emissive = {1, 2, 3};
        p.occlusion = 0.5;
    }
    surfaces.pixels[1].kind = SurfaceKind::unlit;
    surfaces.pixels[2].kind = SurfaceKind::background;
    const ReferenceLights lights{{light_at({0, 0, -3}, 4.0)}, {}};
    const auto rgb = radiance(surfaces, lights, {.ambient = 0.1});
    const double lit = 0.5 / std::numbers::pi * 10 * 0.9375 / 4;
    EXPECT_DOUBLE_EQ(rgb[0], 1 + 0.1 * 0.5 * 0.5 + lit);
    EXPECT_EQ(rgb[3], 1.0);
    EXPECT_EQ(rgb[6], 0.0);
}

TEST(Reference, OrthographicEyeIsStraightBack) {
    SurfaceSamples surfaces = wall_pixel();
    surfaces.pixels[0].position = {3, 0, -5};
    surfaces.pixels[0].roughness = 0.1;
    const ReferenceLights lights{{light_at({3, 0, -3}, 4.0)}, {}};
    const auto ortho = radiance(surfaces, lights, {.shading = Shading::pbr, .orthographic = true});
    const auto perspective = radiance(surfaces, lights, {.shading = Shading::pbr});
    EXPECT_GT(ortho[0], 100 * perspective[0]) << "only the parallel eye looks into the lobe";
}

// 20000 lights over e^12 in strength, against the same terms added in long double.
TEST(Reference, SumIsExactForManyLightsInAnyOrder) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit;
    ReferenceLights lights;
    for (int i = 0; i < 20000; ++i) {
        ReferenceLight light = light_at({4 * unit(random) - 2, 4 * unit(random) - 2, -4}, 9.0);
        light.intensity = glm::dvec3(std::exp(12 * unit(random)));
        lights.lights.push_back(light);
    }
    long double sum = 0.0L;
    for (const ReferenceLight& light : lights.lights) {
        sum += static_cast<long double>(radiance(wall_pixel(), {{light}, {}})[0]);
    }
    const double expected = static_cast<double>(sum);
    EXPECT_NEAR(radiance(wall_pixel(), lights)[0], expected, 1e-15 * expected);
    std::shuffle(lights.lights.begin(), lights.lights.end(), random);
    EXPECT_NEAR(radiance(wall_pixel(), lights)[0], expected, 1e-15 * expected);
}

TEST(Reference, LightsPerPixelCountsThoseInRange) {
    SurfaceSamples surfaces = make_surface_samples(2, 2);
    for (int i = 0; i < 3; ++i) {
        surfaces.pixels[static_cast<std::size_t>(i)] = wall_pixel().pixels[0];
        surfaces.pixels[static_cast<std::size_t>(i)].position.x = i;
    }
    const ReferenceLights lights{{light_at({0, 0, -4.9}, 0.5), light_at({0, 0, -4.9}, 1.5)}, {}};
    EXPECT_DOUBLE_EQ(shade_reference(surfaces, lights, {}).lights_per_pixel, 1.0)
        << "2, 1 and 0 over three hit pixels";
}

TEST(Reference, ReachingCountsOnlyLightsBeyondDoubt) {
    const auto reaching = [](const ReferenceLight& light) {
        return shade_reference(wall_pixel(), {{light}, {}}, {}).reaching.at(0);
    };
    EXPECT_EQ(reaching(light_at({0, 0, -3}, 2.1)), 1u);
    EXPECT_EQ(reaching(light_at({0, 0, -3}, 2.0 * (1 + 1e-5))), 1u);
    EXPECT_EQ(reaching(light_at({0, 0, -3}, 2.0 * (1 + 1e-6))), 0u) << "float32 might round it out";
    EXPECT_EQ(reaching(light_at({0, 0, -3}, 1.9)), 0u);
    ReferenceLight spot = light_at({0, 0, -3}, 4.0);
    spot.axis = {0, 0, 1};  // away from the wall
    spot.cos_out = 0.5;
    EXPECT_EQ(reaching(spot), 0u);
    spot.axis = {0, 0, -1};
    EXPECT_EQ(reaching(spot), 1u);
}

TEST(Reference, ProgressEndsAtOneAndCanStop) {
    const SurfaceSamples surfaces = make_surface_samples(4, 50);
    double last = 0.0;
    shade_reference(surfaces, {}, {.progress = [&](double share) { last = share; }});
    EXPECT_EQ(last, 1.0);
    EXPECT_THROW(shade_reference(surfaces, {}, {.progress = [](double) { throw Interrupted(); }}),
                 Interrupted);
}

TEST(ReferenceLights, RowsAndSceneLightsAgree) {
    Camera camera = look_at({1, 2, 3}, {0, 0, 0}, {0, 1, 0}, 0.8);
    SceneLight spot;
    spot.type = LightType::spot;
    spot.position = {0.5, 1.5, 2.0};
    spot.direction = glm::normalize(glm::dvec3(1, -2, 0.5));
    spot.intensity = {3, 4, 5};
    spot.range = 2.5f;
    spot.inner_cone = 0.3f;
    spot.outer_cone = 0.6f;
    SceneLight sun;
    sun.type = LightType::directional;
    sun.direction = {0, -1, 0};
    const ReferenceLights lights = reference_lights(std::vector<SceneLight>{spot, sun}, camera);
    ASSERT_EQ(lights.lights.size(), 1u);
    ASSERT_EQ(lights.directional.size(), 1u);
    const ReferenceLight& light = lights.lights[0];
    const glm::dvec3 world = camera.position + camera.world_from_view * light.position;
    EXPECT_NEAR(glm::distance(world, spot.position), 0.0, 1e-14);
    EXPECT_DOUBLE_EQ(light.inv_range2, 0.16);
    EXPECT_NEAR(glm::dot(camera.world_from_view * light.axis, spot.direction), 1.0, 1e-14);
    const double cos_in = std::cos(static_cast<double>(spot.inner_cone));
    EXPECT_NEAR((cos_in - light.cos_out) * light.cone_scale, 1.0, 1e-14);
    const glm::dvec3 up = camera.world_from_view * lights.directional[0].to_light;
    EXPECT_NEAR(up.y, 1.0, 1e-14);

    const ShadeLight row{{1, 2, 3, 0.25f}, {4, 5, 6, 7}, {0, 0, -1, 0.5f}};
    const DirectionalLight far{{0, 1, 0, 0}, {9, 8, 7, 0}};
    const ReferenceLights rows = reference_lights(std::span(&row, 1), std::span(&far, 1));
    EXPECT_EQ(rows.lights[0].position, glm::dvec3(1, 2, 3));
    EXPECT_EQ(rows.lights[0].inv_range2, 0.25);
    EXPECT_EQ(rows.lights[0].intensity, glm::dvec3(4, 5, 6));
    EXPECT_EQ(rows.lights[0].cone_scale, 7.0);
    EXPECT_EQ(rows.lights[0].axis, glm::dvec3(0, 0, -1));
    EXPECT_EQ(rows.lights[0].cos_out, 0.5);
    EXPECT_EQ(rows.directional[0].to_light, glm::dvec3(0, 1, 0));
    EXPECT_EQ(rows.directional[0].illuminance, glm::dvec3(9, 8, 7));
}

}  // namespace
}  // namespace kilolux
