// SPDX-License-Identifier: Apache-2.0
// Lights with photometric webs (IES files) in every renderer, with shadows and random ranges.
#include <gtest/gtest.h>

#include <cmath>

#include "host/measure/metrics/metrics.h"
#include "host/measure/reference/decoded_samples.h"
#include "host/scene/lights/photometry/photometry_file.h"
#include "tests/support/ies_text.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

void add_profile(SceneLight& light, Scene& scene, std::size_t web) {
    light.direction = glm::normalize(light.direction);
    const glm::dvec3 aside(0.36, 0.48, 0.8);
    light.side = glm::normalize(glm::cross(light.direction, aside));
    light.profile = static_cast<int>(scene.aimed_profiles.size());
    scene.aimed_profiles.push_back({web, web == 1});
}

/// The grid with every kind of light, every second spot and some points with an uneven web or one
/// that ends sideways. `ranged`: each has a range of its own.
Scene scene_with_profiles(bool ranged = true) {
    Scene scene = grid_with_every_light();
    IesText sideways{.vertical = {0, 30, 90}, .horizontal = {0, 45, 90}};
    sideways.candela = [](double v, double h) { return 50.0 + v + h; };
    for (const IesText& ies : {uneven_ies(), sideways}) {
        scene.webs.push_back(read_photometric_web(ies_text(ies), "test"));
    }
    const Box box = bounds(scene);
    for (std::size_t i = 0; i < 20; ++i) {
        SceneLight light;
        const double t = (static_cast<double>(i) + 0.5) / 20.0;
        light.position = {box.min.x + t * box.size().x, box.max.y + 0.4 + 0.5 * t,
                          box.min.z + std::fmod(7.0 * t, 1.0) * box.size().z};
        light.direction = {0.5 - t, -1.0, 0.3 * t};
        light.intensity = {20.0f, 12.0f + static_cast<float>(i), 9.0f};
        if (ranged) light.range = 6.0f;
        add_profile(light, scene, i % 2);
        scene.lights.push_back(light);
    }
    for (std::size_t i = 0; i < 12; i += 2) add_profile(scene.lights[i], scene, 0);
    return scene;
}

RenderSettings profile_settings(Shading shading = Shading::pbr) {
    RenderSettings settings = small_settings(96, 54, 60);
    settings.shading = shading;
    settings.gbuffer = GBUFFER_FULL;
    return settings;
}

TEST(LightProfiles, ListsChangeNoBitInAnyMode) {
    const Scene scene = scene_with_profiles(false);
    const std::pair<Shadows, Tails> modes[] = {{Shadows::off, Tails::exact},
                                               {Shadows::exact, Tails::stochastic},
                                               {Shadows::sampled, Tails::stochastic}};
    for (const auto& [shadows, tails] : modes) {
        RenderSettings settings = profile_settings();
        settings.shadows = shadows;
        settings.tails = tails;
        SCOPED_TRACE(static_cast<int>(shadows));
        expect_same_bits_without_lists(scene, settings);
    }
}

// Against double with the file's own angles: the error is that of the kernels' sums.
TEST(LightProfiles, ShadeAsTheReferenceDoes) {
    const Scene scene = scene_with_profiles();
    for (const Shading shading : {Shading::lambert, Shading::blinn_phong, Shading::pbr}) {
        const RenderSettings settings = profile_settings(shading);
        Renderer renderer(scene, settings);
        const Camera camera = first_camera(scene);
        const Frame frame = renderer.render(camera, 0.0);
        const ReferencePicture exact =
            shade_reference(renderer.lit_surfaces(), reference_options(renderer, camera));
        double worst = 0.0;
        for (std::size_t i = 0; i < exact.radiance.rgb.size(); ++i) {
            const double scale = exact.scale.rgb[i] + 1e-3;
            worst = std::max(worst, std::abs(frame.radiance[i] - exact.radiance.rgb[i]) / scale);
        }
        EXPECT_LE(worst, 2e-5) << static_cast<int>(shading);
        EXPECT_GT(worst, 0.0);
    }
}

// The forward renderers' shaders have the same text; they differ as they do without profiles.
TEST(LightProfiles, ForwardRenderersHaveThem) {
    expect_forward_pictures_near(scene_with_profiles(), profile_settings(), 0.01);
}

// Drawn ranges, and shadows of drawn lights, are unbiased.
TEST(LightProfiles, DrawnLightsHaveTheSameMean) {
    const Scene scene = scene_with_profiles(false);
    RenderSettings settings = profile_settings(Shading::lambert);
    settings.lights.count = 0;
    settings.shadows = Shadows::exact;
    settings.tails = Tails::exact;
    const Frame exact = render_once(scene, settings);
    settings.shadows = Shadows::sampled;
    settings.tails = Tails::stochastic;
    settings.samples = 64;
    const Frame drawn = render_once(scene, settings);
    const auto total = [](const Frame& frame) {
        double sum = 0.0;
        for (const float value : frame.radiance) sum += value;
        return sum;
    };
    EXPECT_NEAR(total(drawn) / total(exact), 1.0, 0.02);
}

TEST(LightProfiles, AProbeHasTheirShare) {
    const Scene scene = scene_with_profiles();
    Renderer renderer(scene, profile_settings());
    renderer.render(first_camera(scene), 0.0);
    const PixelProbe probe = renderer.probe(48, 40);
    ASSERT_TRUE(probe.has_surface());
    const auto with_web = std::ranges::count_if(
        probe.lights, [](const ProbedLight& light) { return light.web.web != nullptr; });
    EXPECT_GT(with_web, 0);
    EXPECT_LT(static_cast<std::size_t>(with_web), probe.lights.size());
}

TEST(LightProfiles, OnlyScenesWithThemHaveThem) {
    const RenderSettings settings = profile_settings();
    const Scene without = grid_with_every_light();
    const ScenePlan plan = make_scene_plan(without, settings, 10);
    EXPECT_FALSE(plan.kernels.light_profiles);
    EXPECT_NE(feature_options(plan.kernels).text().find("-DHAS_LIGHT_PROFILES=0"),
              std::string::npos);
    const ScenePlan with = make_scene_plan(scene_with_profiles(), settings, 10);
    EXPECT_NE(feature_options(with.kernels).text().find("-DHAS_LIGHT_PROFILES=1"),
              std::string::npos);
}

}  // namespace
}  // namespace kilolux
