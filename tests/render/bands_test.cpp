// SPDX-License-Identifier: Apache-2.0
// Pictures made in bands because memory is short: the same bits as made at once.
#include "host/picture/bands.h"

#include <gtest/gtest.h>

#include "host/base/error.h"
#include "host/base/system/interrupt.h"
#include "host/picture/frame_bands.h"
#include "host/render/plan/memory_plan.h"
#include "kernels/shared/cluster_grid.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;

// The least memory that is not refused, by bisection of the planner's answer.
std::uint64_t least_memory(const Scene& scene, RenderSettings settings) {
    const ScenePlan plan = make_scene_plan(scene, settings, settings.lights.count);
    const DeviceInfo device = describe(choose_device(settings.device));
    std::uint64_t refused = 1, enough = 8192 * kMiB;
    while (refused + 1 < enough) {
        settings.max_memory_bytes = (refused + enough) / 2;
        try {
            plan_memory(scene, settings, plan, device);
            enough = settings.max_memory_bytes;
        } catch (const Error&) {
            refused = settings.max_memory_bytes;
        }
    }
    return enough;
}

void expect_same_frame(const Frame& banded, const Frame& whole) {
    EXPECT_EQ(banded.radiance, whole.radiance);
    EXPECT_EQ(banded.shown_light, whole.shown_light);
    EXPECT_EQ(banded.display, whole.display);
    ASSERT_EQ(banded.aovs.size(), whole.aovs.size());
    for (std::size_t i = 0; i < whole.aovs.size(); ++i) {
        EXPECT_EQ(banded.aovs[i].values, whole.aovs[i].values) << whole.aovs[i].name;
        EXPECT_EQ(banded.aovs[i].ids, whole.aovs[i].ids) << whole.aovs[i].name;
    }
    // A cluster that two bands share is listed for both.
    EXPECT_GE(banded.stats.coarse_pairs, whole.stats.coarse_pairs);
    EXPECT_EQ(banded.stats.active_clusters, whole.stats.active_clusters);
    EXPECT_EQ(banded.stats.refined_pairs, whole.stats.refined_pairs);
    EXPECT_EQ(banded.stats.surface_pixels, whole.stats.surface_pixels);
    EXPECT_NEAR(banded.stats.evaluations_per_pixel, whole.stats.evaluations_per_pixel, 1e-9);
    EXPECT_NEAR(banded.stats.useful_evaluations_per_pixel, whole.stats.useful_evaluations_per_pixel,
                1e-9);
}

// At once, and in bands of the lowest height and of a few.
void expect_same_in_bands(const Scene& scene, RenderSettings settings) {
    settings.max_memory_bytes = 0;
    Renderer at_once(scene, settings);
    ASSERT_GE(at_once.memory().band_rows, settings.height);
    const Frame whole = at_once.render(first_camera(scene), 0.5);
    const std::uint64_t least = least_memory(scene, settings);
    // Lists need some MiB beside the plan.
    settings.max_memory_bytes = least;
    const ScenePlan plan = make_scene_plan(scene, settings, settings.lights.count);
    const DeviceInfo device = describe(choose_device(settings.device));
    EXPECT_EQ(plan_memory(scene, settings, plan, device).band_rows, FINE_TILE);
    for (const int rows : {16, 48, 80}) {
        SCOPED_TRACE(std::to_string(rows) + " rows a band");
        settings.band_rows = rows;
        settings.max_memory_bytes = 0;
        Renderer renderer(scene, settings);
        ASSERT_EQ(renderer.memory().band_rows, rows);
        int samples = 0;  // begun: kernels are built, and parts of a pass tell a share
        const WorkWatch watch([&](double share) { samples += share < 0.0 ? 1 : 0; });
        const Frame banded = renderer.render(first_camera(scene), 0.5);
        EXPECT_EQ(samples, settings.samples * ((settings.height + rows - 1) / rows));
        expect_same_frame(banded, whole);
    }
}

TEST(Bands, CoverThePictureAndKeepWithinRasterTiles) {
    for (const int height : {1, 16, 17, 1080, 4096, 4097, 16384}) {
        for (const int rows : {16, 48, 4096, 8192}) {
            int row = 0;
            for (const Band& band : make_bands(height, rows)) {
                EXPECT_EQ(band.first_row, row);
                EXPECT_GT(band.rows, 0);
                EXPECT_LE(band.rows, rows);
                EXPECT_EQ(band.first_row / kRasterRows,
                          (band.first_row + band.rows - 1) / kRasterRows);
                row += band.rows;
            }
            EXPECT_EQ(row, height);
        }
    }
}

TEST(Bands, ChangeNoBit) {
    for (const uint layout : {GBUFFER_PACKED, GBUFFER_FULL, GBUFFER_HALF}) {
        SCOPED_TRACE(gbuffer_layout_name(layout));
        RenderSettings settings = small_settings(150, 131, 400);
        settings.gbuffer = layout;
        settings.geometry = layout == GBUFFER_HALF ? Geometry::ids : Geometry::compute;
        settings.want.counts = true;
        settings.want.aovs = {"depth", "position", "normal", "light-count", "cluster"};
        expect_same_in_bands(grid_with_every_light(), settings);
    }
}

TEST(Bands, ChangeNoBitOfSamplesBloomAndViews) {
    const Scene scene = make_generated_scene("grid");
    RenderSettings settings = small_settings(150, 131, 400);
    settings.samples = 3;
    settings.bloom = 0.3f;
    expect_same_in_bands(scene, settings);
    settings.samples = 1;
    settings.want.view = ViewKind::lights;
    expect_same_in_bands(scene, settings);
}

TEST(Bands, ChangeNoBitWithEveryLightAtEveryPixel) {
    RenderSettings settings = small_settings(150, 131, 40);
    settings.renderer = RendererKind::deferred_all;
    expect_same_in_bands(make_generated_scene("plain"), settings);
}

// Two renderers take turns with rows of one picture, not in order; a third one finishes it.
void expect_same_by_rows(const Scene& scene, const RenderSettings& settings) {
    Renderer one(scene, settings), two(scene, settings), three(scene, settings);
    const Camera camera = first_camera(scene);
    const Frame whole = one.render(camera, 0.5);
    const std::unique_ptr<SharedPicture> picture = two.begin_rows();
    const std::vector<FrameStats> parts = {one.render_rows(*picture, camera, 0.5, {64, 67}),
                                           two.render_rows(*picture, camera, 0.5, {0, 16}),
                                           two.render_rows(*picture, camera, 0.5, {16, 48})};
    FrameStats second = parts[1];
    add_rows(second, parts[2]);
    const FrameStats end = three.finish_rows(*picture, camera, 0.5);
    picture->frame.stats = joined({parts[0], second});
    const FrameStats& stats = picture->frame.stats;
    expect_same_frame(picture->frame, whole);
    EXPECT_EQ(stats.lights_given, whole.stats.lights_given);
    EXPECT_EQ(stats.frame_ms, std::max(parts[0].frame_ms, second.frame_ms)) << "of the slowest";
    EXPECT_EQ(end.frame_ms > 0.0, settings.bloom > 0.0f);
}

TEST(Bands, RowsOfTwoRenderersMakeThePicture) {
    const Scene scene = make_generated_scene("grid");
    RenderSettings settings = small_settings(150, 131, 400);
    settings.want.counts = true;
    settings.want.aovs = {"depth", "normal", "light-count", "cluster"};
    for (const Geometry geometry : {Geometry::compute, Geometry::ids}) {
        settings.geometry = geometry;
        expect_same_by_rows(scene, settings);
    }
    settings.samples = 3;
    settings.bloom = 0.3f;
    settings.want.shown_light = true;
    expect_same_by_rows(scene, settings);
    settings.samples = 1;
    settings.want.aovs.clear();
    settings.want.view = ViewKind::lights;
    expect_same_by_rows(scene, settings);
}

// A camera that sees some rows sees in them what the whole picture's camera sees there.
TEST(Bands, CroppedCameraSeesItsRows) {
    const Scene scene = make_generated_scene("grid");
    Camera camera = first_camera(scene);
    camera.shear = {0.1, -0.2};
    for (const bool parallel : {false, true}) {
        camera.orthographic = parallel;
        camera.z_far = 1000.0;
        const int width = 160, height = 120;
        const Band rows{32, 48};
        const View whole = view_of(camera, width, height);
        const View part = view_of(crop(camera, height, rows), width, rows.rows);
        for (const float y : {0.5f, 20.5f, 47.5f}) {
            for (const float x : {0.5f, 100.5f}) {
                const FV3 p = view_position(whole, x, y + 32.0f, 3.0f);
                const FV3 q = view_position(part, x, y, 3.0f);
                EXPECT_NEAR(p.x, q.x, 1e-5);
                EXPECT_NEAR(p.y, q.y, 1e-5);
                EXPECT_EQ(p.z, q.z);
            }
        }
    }
}

std::string plan_error(const RenderSettings& settings) {
    const Scene scene = make_generated_scene("plain");
    try {
        plan_memory(scene, settings, make_scene_plan(scene, settings, settings.lights.count),
                    describe(choose_device(settings.device)));
        return "";
    } catch (const Error& error) {
        return error.what();
    }
}

TEST(MemoryPlan, SaysWhatIsNeededAndWhatThereIs) {
    RenderSettings settings = small_settings(16384, 16384, 1000);
    settings.max_memory_bytes = 1024 * kMiB;
    const std::string error = plan_error(settings);
    EXPECT_TRUE(error.starts_with("memory: 16384x16384 pixels with 1000 lights need at least "))
        << error;
    EXPECT_TRUE(error.ends_with(" MiB; --max-memory is 1024 MiB")) << error;
    settings.max_memory_bytes = 16384 * kMiB;
    EXPECT_EQ(plan_error(settings), "");
    settings.lights.count = std::uint64_t{1} << 31;
    EXPECT_NE(plan_error(settings), "");
    EXPECT_THROW(check_light_memory(settings.lights.count, settings), Error);
}

TEST(MemoryPlan, ListsThatDoNotFitAreRefusedByTheirStage) {
    const Scene scene = make_generated_scene("plain");
    RenderSettings settings = small_settings(320, 180, 150000);
    settings.lights.radius = 1000.0;  // every light in every cluster with pixels
    settings.grid.tiles_x = settings.grid.tiles_y = 64;
    settings.max_memory_bytes = 360 * kMiB;
    try {
        render_once(scene, settings);
        FAIL() << "took more than it may";
    } catch (const Error& error) {
        const std::string message = error.what();
        EXPECT_TRUE(message.starts_with("cull_lights: needs ")) << message;
        EXPECT_TRUE(message.ends_with(" MiB are left (--max-memory)")) << message;
    }
}

}  // namespace
}  // namespace kilolux
