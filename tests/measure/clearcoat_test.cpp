// SPDX-License-Identifier: Apache-2.0
// KHR_materials_clearcoat on a sphere of car paint: every renderer against float64 rays.
#include <gtest/gtest.h>

#include <cmath>

#include "host/measure/reference/decoded_samples.h"
#include "host/measure/reference/ray_cast_reference.h"
#include "tests/support/render_fixture.h"
#include "tests/support/sphere_scene.h"

namespace kilolux {
namespace {

const Camera kCamera = look_at({0.5, 0.8, 4.0}, {0, 0, 0}, {0, 1, 0}, 0.55);

SceneLight light_at(const glm::dvec3& position, LightType type) {
    SceneLight light;
    light.type = type;
    light.position = position;
    light.direction = -glm::normalize(position);
    light.intensity = type == LightType::directional ? glm::vec3(0.4f) : glm::vec3(9, 8, 7);
    light.range = type == LightType::directional ? 0.0f : 9.0f;
    return light;
}

Scene lit_car_paint() {
    Scene scene = car_paint_scene();
    for (int i = 0; i < 12; ++i) {
        const double angle = 0.5 * i;
        const LightType type = i % 3 == 0 ? LightType::spot : LightType::point;
        scene.lights.push_back(
            light_at({2.5 * std::cos(angle), 0.4 * i - 2.0, 2.5 * std::sin(angle)}, type));
    }
    scene.lights.push_back(light_at({1, 2, 1}, LightType::directional));
    return scene;
}

RenderSettings full_settings() {
    RenderSettings settings = small_settings(96, 96, 0);
    settings.gbuffer = GBUFFER_FULL;
    settings.ambient = 0.1f;
    return settings;
}

// Relative differences at the pixels that a float64 ray finds within a quarter of the sphere's
// silhouette.
std::vector<double> differences(const Scene& scene, const RenderSettings& settings) {
    const SurfaceSamples samples = RayCaster(scene).cast(kCamera, settings.width, settings.height);
    const ReferencePicture expected =
        shade_reference(samples, reference_lights(scene.lights, kCamera, &scene),
                        {.shading = Shading::pbr, .ambient = double{settings.ambient}});
    const Frame frame = Renderer(scene, settings).render(kCamera, 0.0);
    std::vector<double> out;
    for (std::size_t i = 0; i < frame.radiance.size(); ++i) {
        const SurfaceSample& s = samples.pixels[i / 3];
        if (s.kind != SurfaceKind::lit) continue;
        if (glm::dot(s.normal, -glm::normalize(s.position)) < 0.2) continue;
        const double right = expected.radiance.rgb[i];
        out.push_back(std::abs(frame.radiance[i] - right) / right);
    }
    return out;
}

TEST(Clearcoat, EveryRendererShowsTheFloat64Reference) {
    const Scene scene = lit_car_paint();
    for (const RendererKind renderer : {RendererKind::deferred, RendererKind::deferred_all,
                                        RendererKind::forward, RendererKind::forward_plus}) {
        RenderSettings settings = full_settings();
        settings.renderer = renderer;
        const std::vector<double> found = differences(scene, settings);
        EXPECT_GT(found.size(), 3000u);
        EXPECT_LT(quantile(found, 0.5), 2e-5) << static_cast<int>(renderer);
        EXPECT_LT(quantile(found, 0.99), 5e-4) << static_cast<int>(renderer);
    }
    EXPECT_LT(quantile(differences(scene,
                                   [] {
                                       RenderSettings settings = full_settings();
                                       settings.gbuffer = GBUFFER_PACKED;
                                       return settings;
                                   }()),
                       0.5),
              1e-2);
}

TEST(Clearcoat, ListsAndAllLightsAreTheSameBits) {
    const Scene scene = lit_car_paint();
    RenderSettings settings = small_settings(96, 96, 200);
    settings.shadows = Shadows::exact;
    const Frame listed = Renderer(scene, settings).render(kCamera, 0.0);
    for (const int lanes : {1, 4}) {
        settings.kernels.lanes = lanes;
        EXPECT_EQ(Renderer(scene, settings).render(kCamera, 0.0).radiance, listed.radiance);
    }
    settings.renderer = RendererKind::deferred_all;
    EXPECT_EQ(Renderer(scene, settings).render(kCamera, 0.0).radiance, listed.radiance);
}

TEST(Clearcoat, AFactorOfZeroIsTheMaterialWithoutIt) {
    Scene scene = lit_car_paint();
    scene.images.push_back({"black", 1, 1, {0, 0, 0, 255}});
    scene.textures.push_back({static_cast<int>(scene.images.size()) - 1, {}});
    Material& m = scene.materials[0];
    m.clearcoat_texture.texture = static_cast<int>(scene.textures.size()) - 1;
    for (const uint layout : {GBUFFER_PACKED, GBUFFER_FULL}) {
        RenderSettings settings = full_settings();
        settings.gbuffer = layout;
        Scene plain = scene;
        plain.materials[0].clearcoat = 0.0f;
        Renderer without(plain, settings), with(scene, settings);
        EXPECT_FALSE(without.plan().kernels.clearcoat);
        EXPECT_TRUE(with.plan().kernels.clearcoat);
        EXPECT_EQ(with.render(kCamera, 0.0).radiance, without.render(kCamera, 0.0).radiance);
    }
}

}  // namespace
}  // namespace kilolux
