// SPDX-License-Identifier: Apache-2.0
// Results that a frame keeps from the last one change no byte.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

// A viewer's edits, any of which may leave the picture unchanged.
class Script {
 public:
    Script(const Scene& scene, std::uint32_t seed)
        : random_(seed), camera(first_camera(scene)), settings(small_settings(64, 48, 200)) {}

    void edit() {
        switch (random_() % 9) {
            case 0:
                camera.position.x += 0.1 * static_cast<double>(random_() % 3);
                break;
            case 1:
            case 2:
                time += 0.3 * static_cast<double>(random_() % 3);
                break;
            case 3:
                settings.exposure = static_cast<float>(random_() % 2);
                break;
            case 4:
                settings.lights.count = 150 + 50 * (random_() % 2);
                break;
            case 5:
                settings.height = 32 + 16 * static_cast<int>(random_() % 2);
                break;
            case 6:
                settings.renderer =
                    random_() % 2 == 0 ? RendererKind::deferred : RendererKind::deferred_all;
                break;
            case 7:
                settings.geometry = random_() % 2 == 0 ? Geometry::ids : Geometry::compute;
                break;
            default:
                settings.grid.slices_per_octave = 4 << (random_() % 2);
        }
    }

 private:
    std::mt19937 random_;

 public:
    Camera camera;
    RenderSettings settings;
    double time = 0.0;
};

TEST(Reuse, ChangesNoByteOfRandomScripts) {
    const Scene scene = grid_with_every_light();
    Script script(scene, 5);
    RenderSettings anew = script.settings;
    anew.no_reuse = true;
    Renderer keeping(scene, script.settings);
    Renderer making(scene, anew);
    int kept = 0;
    for (int i = 0; i < 60; ++i) {
        script.edit();
        anew = script.settings;
        anew.no_reuse = true;
        keeping.change(script.settings);
        making.change(anew);
        const Frame a = keeping.render(script.camera, script.time);
        const Frame b = making.render(script.camera, script.time);
        ASSERT_EQ(a.display, b.display) << i;
        ASSERT_EQ(a.radiance, b.radiance) << i;
        EXPECT_TRUE(has_stage(b, "resolve_surfaces")) << i;
        if (!has_stage(a, "resolve_surfaces")) ++kept;
    }
    EXPECT_GT(kept, 10) << "surfaces were never kept";
}

TEST(Reuse, AStillCameraKeepsSurfacesAndBins) {
    const Scene scene = make_generated_scene("grid");
    Renderer renderer(scene, small_settings());
    const Camera camera = first_camera(scene);
    renderer.render(camera, 0.0);
    renderer.render(camera, 0.0);  // lists have their room
    const Frame moved = renderer.render(camera, 0.1);
    for (const char* stage : {"geometry", "gbuffer_bridge", "bin_triangles", "raster_triangles",
                              "resolve_surfaces", "bin_pixels"}) {
        EXPECT_FALSE(has_stage(moved, stage)) << stage;
    }
    EXPECT_TRUE(has_stage(moved, "move_lights"));
    EXPECT_FALSE(has_stage(renderer.render(camera, 0.1), "move_lights"));
}

TEST(Reuse, NothingThatMovesKeepsLists) {
    const Scene scene = make_generated_scene("grid");
    RenderSettings settings = small_settings();
    Renderer renderer(scene, settings);
    const Camera camera = first_camera(scene);
    renderer.render(camera, 0.0);
    const Frame first = renderer.render(camera, 0.0);
    settings.exposure = 1.0f;
    renderer.change(settings);
    const Frame brighter = renderer.render(camera, 0.0);
    for (const char* stage : {"cull_lights", "refine_lights", "count_pairs"}) {
        EXPECT_FALSE(has_stage(brighter, stage)) << stage;
    }
    EXPECT_EQ(first.radiance, brighter.radiance);
    EXPECT_NE(first.display, brighter.display);
    EXPECT_EQ(first.stats.refined_pairs, brighter.stats.refined_pairs);
    EXPECT_TRUE(has_stage(renderer.render(camera, 0.1), "cull_lights"));
}

// Every value is written anew.
TEST(Reuse, FramesTakeTheMemoryOfSpareOnes) {
    const Scene scene = make_generated_scene("grid");
    RenderSettings settings = small_settings();
    settings.band_rows = 16;
    settings.bloom = 0.2f;
    settings.want.shown_light = true;
    Renderer renderer(scene, settings);
    const Camera camera = first_camera(scene);
    const Frame wanted = renderer.render(camera, 0.0);
    Frame spare = wanted;
    std::ranges::fill(spare.radiance, 1e30f);
    std::ranges::fill(spare.shown_light, 1e30f);
    std::ranges::fill(spare.display, std::uint8_t{77});
    const void* const light = spare.radiance.data();
    const void* const shown = spare.shown_light.data();
    const void* const display = spare.display.data();
    renderer.spare_frames()->give(std::move(spare));
    const Frame again = renderer.render(camera, 0.0);
    EXPECT_EQ(again.radiance, wanted.radiance);
    EXPECT_EQ(again.shown_light, wanted.shown_light);
    EXPECT_EQ(again.display, wanted.display);
    EXPECT_EQ(light, again.radiance.data());
    EXPECT_EQ(shown, again.shown_light.data());
    EXPECT_EQ(display, again.display.data());
    EXPECT_TRUE(renderer.spare_frames()->take().display.empty()) << "it is taken";
}

}  // namespace
}  // namespace kilolux
