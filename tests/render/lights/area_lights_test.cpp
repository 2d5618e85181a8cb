// SPDX-License-Identifier: Apache-2.0
// Lights with a size in every renderer: lists, references, forward shaders, what scenes without
// them lack.
#include <gtest/gtest.h>

#include <cmath>

#include "host/measure/metrics/metrics.h"
#include "host/measure/reference/decoded_samples.h"
#include "host/scene/lights/light_kinds.h"
#include "tests/render/shadows/soft_scenes.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

// The grid with every other kind of light, and above it lights of each kind with a size; every
// third flat one shines to both sides.
Scene scene_with_areas() {
    Scene scene = grid_with_every_light();
    const Box box = bounds(scene);
    for (std::size_t i = 0; i < 24; ++i) {
        SceneLight light;
        const double t = (static_cast<double>(i) + 0.5) / 24.0;
        light.type = kSizedTypes[i % kSizedTypes.size()];
        light.position = {box.min.x + t * box.size().x, box.max.y + 0.2 + 0.8 * t,
                          box.min.z + std::fmod(7.0 * t, 1.0) * box.size().z};
        light.direction = glm::normalize(glm::dvec3(0.5 - t, i % 5 == 4 ? 0.3 : -1.0, 0.3 * t));
        light.side = glm::normalize(glm::cross(light.direction, glm::dvec3(0.36, 0.48, 0.8)));
        light.width = 0.3f + 0.1f * static_cast<float>(i % 7);
        light.height = 0.6f;
        light.skew = 0.2f;
        light.radius = 0.15f;
        light.two_sided = i % 3 == 0 && kind_of(light).is_flat;
        light.intensity = {20.0f, 12.0f + static_cast<float>(i), 9.0f};
        light.range = 6.0f;
        scene.lights.push_back(light);
    }
    // A triangle seen from behind, which shines there, too, and a sphere around some surfaces.
    SceneLight& triangle = scene.lights[scene.lights.size() - 21];
    triangle.direction = {0.0, 1.0, 0.0};
    triangle.side = {1.0, 0.0, 0.0};
    SceneLight& sphere = scene.lights[scene.lights.size() - 18];
    sphere.position.y = box.max.y;
    sphere.radius = 1.0f;
    return scene;
}

RenderSettings area_settings(Shading shading = Shading::pbr) {
    RenderSettings settings = small_settings(64, 36, 60);
    settings.shading = shading;
    settings.gbuffer = GBUFFER_FULL;
    return settings;
}

struct Difference {
    double worst = 0.0;  // relative to the light that arrives
    double mean = 0.0;   // of the sum of absolute values
};

Difference from_reference(const Scene& scene, Shading shading) {
    Renderer renderer(scene, area_settings(shading));
    const Camera camera = first_camera(scene);
    const Frame frame = renderer.render(camera, 0.0);
    const ReferencePicture exact =
        shade_reference(renderer.lit_surfaces(), reference_options(renderer, camera));
    Difference out;
    double difference = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < exact.radiance.rgb.size(); ++i) {
        const double error = std::abs(frame.radiance[i] - exact.radiance.rgb[i]);
        out.worst = std::max(out.worst, error / (exact.scale.rgb[i] + 1e-3));
        difference += error;
        sum += exact.radiance.rgb[i];
    }
    out.mean = difference / sum;
    return out;
}

TEST(AreaLights, ListsChangeNoBitInAnyMode) {
    const Scene scene = scene_with_areas();
    for (const Shading shading : {Shading::lambert, Shading::pbr}) {
        for (const Shadows shadows : {Shadows::off, Shadows::sampled}) {
            RenderSettings settings = area_settings(shading);
            settings.shadows = shadows;
            SCOPED_TRACE(testing::Message()
                         << static_cast<int>(shading) << " " << static_cast<int>(shadows));
            expect_same_bits_without_lists(scene, settings);
        }
    }
}

// Diffuse light is exact; GGX light is an approximation:
// host/measure/reference/area/ggx_area_error.md.
TEST(AreaLights, ShadeAsTheReferenceDoes) {
    const Scene scene = scene_with_areas();
    const Difference lambert = from_reference(scene, Shading::lambert);
    EXPECT_LE(lambert.worst, 2e-5);
    EXPECT_GT(lambert.worst, 0.0);
    EXPECT_LE(from_reference(scene, Shading::pbr).mean, 0.02);
}

TEST(AreaLights, ForwardRenderersHaveThem) {
    expect_forward_pictures_near(scene_with_areas(), area_settings(), 0.01);
}

// The same light is received wherever the size tends to 0.
TEST(AreaLights, TendToPoints) {
    Scene points = grid_with_every_light(), spheres = points;
    for (SceneLight& light : points.lights) light.type = LightType::point;
    for (SceneLight& light : spheres.lights) {
        light.type = LightType::sphere;
        light.radius = 1e-3f;
    }
    RenderSettings settings = area_settings();
    settings.lights.count = 0;
    const Frame of_points = render_once(points, settings);
    const Frame of_spheres = render_once(spheres, settings);
    EXPECT_GT(*std::ranges::max_element(of_points.radiance), 0.01f);
    EXPECT_LT(mean_difference(of_points, of_spheres), 1e-3);
}

// Generated lights are spheres with LightOptions::size, and move.
TEST(AreaLights, GeneratedLightsAreSpheres) {
    const Scene scene = make_generated_scene("grid");
    RenderSettings settings = area_settings();
    settings.lights.size = 0.1;
    expect_same_bits_without_lists(scene, settings);
    const Frame spheres = render_once(scene, settings);
    settings.lights.size = 0.0;
    EXPECT_NE(render_once(scene, settings).radiance, spheres.radiance);
}

TEST(AreaLights, OnlyScenesWithThemHaveThem) {
    const RenderSettings settings = area_settings();
    const ScenePlan plan = make_scene_plan(grid_with_every_light(), settings, 10);
    EXPECT_FALSE(plan.kernels.area_lights);
    const ScenePlan with = make_scene_plan(scene_with_areas(), settings, 10);
    EXPECT_TRUE(with.kernels.area_lights);
    EXPECT_TRUE(with.kernels.spot_lights);
}

}  // namespace
}  // namespace kilolux
