// SPDX-License-Identifier: Apache-2.0
// Sampled shadows of lights with a size are the same bits in every form.
#include <gtest/gtest.h>

#include "host/certify/shadow_scenarios.h"
#include "host/measure/bench/lighting_bench.h"
#include "tests/render/shadows/soft_scenes.h"
#include "tests/support/full.h"

namespace kilolux {
namespace {

// All kinds of lights with a size among points, spots and a directional light.
Scene grid_with_area_lights() {
    Scene scene = grid_with_every_light();
    const Box box = bounds(scene);
    for (std::size_t i = 0; i < 5; ++i) {
        SceneLight light = panel(kSizedTypes[i % kSizedTypes.size()]);
        const double t = (static_cast<double>(i) + 0.5) / 5.0;
        light.position = {box.min.x + t * box.size().x, box.max.y + 0.3,
                          box.min.z + (1.0 - t) * box.size().z};
        light.two_sided = i == 4;
        light.intensity = {60.0f, 40.0f, 50.0f};
        light.range = 3.0f * static_cast<float>(glm::length(box.size()));
        scene.lights.push_back(light);
    }
    return scene;
}

RenderSettings bits_settings(int width, int height) {
    RenderSettings settings = soft_settings(width, height, 6);
    settings.shading = Shading::pbr;
    settings.lights.count = 20;
    return settings;
}

TEST(SoftShadowBits, AreThoseOfEveryLight) {
    const Scene scene = grid_with_area_lights();
    RenderSettings settings = bits_settings(96, 54);
    settings.samples = 2;
    settings.want.aovs = {"error-standard"};
    const Frame listed = render_once(scene, settings);
    settings.renderer = RendererKind::deferred_all;
    const Frame all = render_once(scene, settings);
    EXPECT_EQ(all.radiance, listed.radiance);
    EXPECT_EQ(all.aovs.front().values, listed.aovs.front().values);
    settings.shadows = Shadows::off;
    settings.want.aovs.clear();
    EXPECT_NE(render_once(scene, settings).radiance, listed.radiance);
}

// So many lights and rays that a lobe's rays may fill the row of the last for which there is room.
TEST(SoftShadowBits, OfManyLanternsAreThoseOfEveryLight) {
    const Scene scene = make_generated_scene("lanterns");
    RenderSettings settings = soft_settings(160, 100, 16);
    settings.shading = Shading::pbr;
    settings.lights.count = 0;
    const Frame listed = render_once(scene, settings);
    settings.renderer = RendererKind::deferred_all;
    EXPECT_EQ(render_once(scene, settings).radiance, listed.radiance);
}

// The first ray of a single pixel passes beside the board that others meet.
TEST(SoftShadowBits, OfAPixelInPenumbraAreThoseOfEveryLight) {
    const Scene scene = board_below(panel(LightType::rectangle)).scene;
    RenderSettings settings = soft_settings(1, 1, 8);
    const Camera camera = look_at({0.5, 3.5, 4.5}, {1.55, 0.0, 0.06}, {0, 1, 0}, 0.01);
    Renderer by_lists(scene, settings);
    settings.renderer = RendererKind::deferred_all;
    Renderer by_all(scene, settings);
    for (uint seed = 1; seed <= 100; ++seed) {
        settings.seed = seed;
        by_all.change(settings);
        const Frame all = by_all.render(camera, 0.0);
        RenderSettings listed = settings;
        listed.renderer = RendererKind::deferred;
        by_lists.change(listed);
        EXPECT_EQ(by_lists.render(camera, 0.0).radiance, all.radiance) << seed;
    }
}

TEST(SoftShadowBits, AreTheSameInBandsAndInAnotherGrid) {
    const Scene scene = grid_with_area_lights();
    RenderSettings settings = bits_settings(96, 64);
    const Frame whole = render_once(scene, settings);
    settings.band_rows = 16;
    EXPECT_EQ(render_once(scene, settings).radiance, whole.radiance);
    settings.band_rows = 0;
    settings.grid = {5, 3, 2, 2};
    EXPECT_EQ(render_once(scene, settings).radiance, whole.radiance);
}

TEST(SoftShadowBits, AreTheSameForEveryLaunch) {
    const Scene scene = grid_with_area_lights();
    const RenderSettings settings = bits_settings(96, 54);
    LightingBench bench(scene, settings, first_camera(scene));
    LightingRequest request = bench.request();
    request.runs = 1;
    request.tuning.tuning.shadow_group = 1;
    const std::uint64_t picture = bench.run(request).picture;
    for (const int group : {0, 32, 64, 256}) {
        request.tuning.tuning.shadow_group = group;
        EXPECT_EQ(bench.run(request).picture, picture) << group << " work-items";
    }
    request.tuning.tuning.shadow_group = 1;
    request.tuning.tuning.shade_rows = 1;
    for (const int lanes : runs_full() ? lane_widths() : std::vector{1, 16}) {
        request.tuning.lanes = lanes;
        EXPECT_EQ(bench.run(request).picture, picture) << lanes << " lanes";
    }
}

}  // namespace
}  // namespace kilolux
