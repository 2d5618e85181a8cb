// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/measure/reference/ray_cast_reference.h"
#include "host/measure/reference/reference.h"
#include "tests/support/render_fixture.h"
#include "tests/support/sphere_scene.h"

namespace kilolux {

/// Sees a sphere_scene() whole.
inline Camera sphere_camera() { return look_at({0.5, 0.8, 4.0}, {0, 0, 0}, {0, 1, 0}, 0.55); }

inline RenderSettings lobe_settings(uint gbuffer = GBUFFER_FULL) {
    RenderSettings settings = small_settings(96, 96, 0);
    settings.gbuffer = gbuffer;
    settings.ambient = 0.1f;
    return settings;
}

/// The sphere lit by a ring of points and spots, and a directional light.
inline Scene with_ring_of_lights(Scene scene) {
    for (int i = 0; i < 12; ++i) {
        const double angle = 0.5 * i;
        SceneLight light;
        light.type = i % 3 == 0 ? LightType::spot : LightType::point;
        light.position = {2.5 * std::cos(angle), 0.4 * i - 2.0, 2.5 * std::sin(angle)};
        light.direction = -glm::normalize(light.position);
        light.intensity = glm::vec3(9, 8, 7);
        light.range = 9.0f;
        scene.lights.push_back(light);
    }
    SceneLight sun;
    sun.type = LightType::directional;
    sun.direction = -glm::normalize(glm::dvec3(1, 2, 1));
    sun.intensity = glm::vec3(0.4f);
    scene.lights.push_back(sun);
    return scene;
}

/// Relative differences from float64 rays, at the pixels off the sphere's silhouette.
inline std::vector<double> reference_differences(const Scene& scene,
                                                 const RenderSettings& settings) {
    const Camera camera = sphere_camera();
    const SurfaceSamples samples = RayCaster(scene).cast(camera, settings.width, settings.height);
    const ReferencePicture expected =
        shade_reference(samples, reference_lights(scene.lights, camera, &scene),
                        {.shading = Shading::pbr, .ambient = double{settings.ambient}});
    const Frame frame = Renderer(scene, settings).render(camera, 0.0);
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

/// `differences` of settings: relative, from float64 rays.
template <typename Differences>
void expect_reference_in_every_renderer(const Differences& differences) {
    for (const RendererKind renderer : {RendererKind::deferred, RendererKind::deferred_all,
                                        RendererKind::forward, RendererKind::forward_plus}) {
        RenderSettings settings = lobe_settings();
        settings.renderer = renderer;
        const std::vector<double> found = differences(settings);
        EXPECT_GT(found.size(), 3000u);
        EXPECT_LT(quantile(found, 0.5), 2e-5) << static_cast<int>(renderer);
        EXPECT_LT(quantile(found, 0.99), 5e-4) << static_cast<int>(renderer);
    }
    EXPECT_LT(quantile(differences(lobe_settings(GBUFFER_PACKED)), 0.5), 1e-2);
}

inline void expect_reference_in_every_renderer(const Scene& scene) {
    expect_reference_in_every_renderer(
        [&](const RenderSettings& settings) { return reference_differences(scene, settings); });
}

inline void expect_lists_and_all_lights_same(const Scene& scene,
                                             const Camera& camera = sphere_camera()) {
    RenderSettings settings = small_settings(96, 96, 200);
    settings.shadows = Shadows::exact;
    const auto radiance = [&] { return Renderer(scene, settings).render(camera, 0.0).radiance; };
    const std::vector<float> listed = radiance();
    for (const int lanes : {1, 4}) {
        settings.kernels.lanes = lanes;
        EXPECT_EQ(radiance(), listed);
    }
    settings.renderer = RendererKind::deferred_all;
    EXPECT_EQ(radiance(), listed);
}

/// `with` compiles the feature in, but no surface shows it; `without` leaves it out.
inline void expect_same_without(const Scene& with, const Scene& without,
                                bool SceneFeatures::*feature) {
    for (const uint layout : {uint{GBUFFER_PACKED}, uint{GBUFFER_FULL}}) {
        Renderer a(with, lobe_settings(layout)), b(without, lobe_settings(layout));
        EXPECT_TRUE(a.plan().kernels.*feature);
        EXPECT_FALSE(b.plan().kernels.*feature);
        EXPECT_EQ(a.render(sphere_camera(), 0.0).radiance, b.render(sphere_camera(), 0.0).radiance);
    }
}

}  // namespace kilolux
