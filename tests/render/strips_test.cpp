// SPDX-License-Identifier: Apache-2.0
// Pictures that are handed over strip by strip: the same bits as made as a whole.
#include <gtest/gtest.h>

#include "host/base/error.h"
#include "host/render/plan/memory_plan.h"
#include "host/render/render_context.h"
#include "kernels/shared/cluster_grid.h"
#include "tests/support/messages.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20;
constexpr std::uint64_t kGiB = std::uint64_t{1} << 30;

// The strip's part of values of the whole picture, `channels` a pixel.
template <typename T>
std::vector<T> rows_of(const std::vector<T>& whole, const Frame& strip, std::size_t channels) {
    const std::size_t row = channels * static_cast<std::size_t>(strip.width);
    const auto first = whole.begin() + static_cast<std::ptrdiff_t>(row) *
                                           static_cast<std::ptrdiff_t>(strip.first_row);
    return {first, first + static_cast<std::ptrdiff_t>(row) * strip.height};
}

// Strips that end within a band and a tile of the grid, not in order.
void expect_same_in_strips(const Scene& scene, const RenderSettings& settings) {
    Renderer renderer(scene, settings);
    const Camera camera = first_camera(scene);
    const Frame whole = renderer.render(camera, 0.5);
    for (const Band& rows : {Band{96, 35}, Band{0, 32}, Band{32, 64}}) {
        const Frame strip = renderer.render_strip(camera, 0.5, rows);
        ASSERT_EQ(strip.height, rows.rows);
        ASSERT_EQ(strip.first_row, rows.first_row);
        EXPECT_TRUE(strip.radiance == rows_of(whole.radiance, strip, 3));
        EXPECT_TRUE(strip.display == rows_of(whole.display, strip, 4));
        ASSERT_EQ(strip.aovs.size(), whole.aovs.size());
        for (std::size_t i = 0; i < whole.aovs.size(); ++i) {
            const Layer& layer = whole.aovs[i];
            const std::size_t channels = layer.channels.size();
            if (layer.is_id()) {
                EXPECT_TRUE(strip.aovs[i].ids == rows_of(layer.ids, strip, channels)) << layer.name;
                EXPECT_GE(strip.aovs[i].most_id, std::ranges::max(layer.ids)) << layer.name;
            } else {
                EXPECT_TRUE(strip.aovs[i].values == rows_of(layer.values, strip, channels))
                    << layer.name;
            }
        }
        EXPECT_GT(strip.stats.frame_ms, 0.0);
        EXPECT_EQ(strip.stats.lights_given, whole.stats.lights_given);
    }
}

// A pixel of a frame's values, `channels` each, whose first pixel is (x, y) of the picture.
template <typename T>
std::vector<T> pixels_of(const std::vector<T>& values, int width, const PixelRect& rect,
                         std::size_t channels) {
    std::vector<T> out;
    for (int y = rect.y; y < rect.y + rect.height; ++y) {
        const auto begin =
            values.begin() + static_cast<std::ptrdiff_t>(channels) * (y * width + rect.x);
        out.insert(out.end(), begin, begin + static_cast<std::ptrdiff_t>(channels) * rect.width);
    }
    return out;
}

void expect_same_in_crops(const Scene& scene, const RenderSettings& settings) {
    Renderer renderer(scene, settings);
    const Camera camera = first_camera(scene);
    const Frame whole = renderer.render(camera, 0.5);
    for (const PixelRect& rect :
         {PixelRect{0, 0, 150, 131}, PixelRect{17, 33, 5, 70}, PixelRect{149, 130, 1, 1}}) {
        const Frame crop = renderer.render_crop(camera, 0.5, rect);
        ASSERT_EQ(crop.width, rect.width);
        ASSERT_EQ(crop.height, rect.height);
        EXPECT_TRUE(crop.radiance == pixels_of(whole.radiance, 150, rect, 3)) << rect.y;
        EXPECT_TRUE(crop.display == pixels_of(whole.display, 150, rect, 4)) << rect.y;
        ASSERT_EQ(crop.aovs.size(), whole.aovs.size());
        for (std::size_t i = 0; i < whole.aovs.size(); ++i) {
            const Layer& layer = whole.aovs[i];
            const std::size_t channels = layer.channels.size();
            EXPECT_TRUE(crop.aovs[i].values ==
                        pixels_of(layer.values, 150, rect, layer.is_id() ? 0 : channels));
            EXPECT_TRUE(crop.aovs[i].ids ==
                        pixels_of(layer.ids, 150, rect, layer.is_id() ? channels : 0));
        }
        EXPECT_EQ(crop.stats.lights_given, whole.stats.lights_given);
    }
}

// Also where bloom or a view needs the whole picture, and through blended surfaces.
TEST(Crops, HaveTheBitsOfThePicture) {
    Scene scene = grid_with_every_light();
    RenderSettings settings = small_settings(150, 131, 400);
    settings.want.aovs = {"depth", "normal", "light-count"};
    settings.band_rows = FINE_TILE;
    expect_same_in_crops(scene, settings);
    settings.want.aovs.clear();
    settings.bloom = 0.5f;
    expect_same_in_crops(scene, settings);
    settings.bloom = 0.0f;
    settings.want.view = ViewKind::normal;
    expect_same_in_crops(scene, settings);
    settings.want.view = ViewKind::lit;
    settings.auto_samples = {.on = true, .error = 0.01f, .most = 8};
    expect_same_in_crops(scene, settings);
    settings.auto_samples = {};
    scene.materials[0].alpha_mode = AlphaMode::blend;
    scene.materials[0].base_color.w = 0.5f;
    expect_same_in_crops(scene, settings);
}

TEST(Crops, LieWithinThePicture) {
    const Scene scene = make_generated_scene("grid");
    Renderer renderer(scene, small_settings(64, 36, 10));
    for (const PixelRect& rect : {PixelRect{-1, 0, 4, 4}, PixelRect{0, 33, 4, 4},
                                  PixelRect{61, 0, 4, 4}, PixelRect{0, 0, 0, 4}}) {
        EXPECT_TRUE(contains(
            message_of<Error>([&] { renderer.render_crop(first_camera(scene), 0.0, rect); }),
            "of a picture of 64x36 pixels"));
    }
}

TEST(Strips, HaveTheBitsOfThePicture) {
    const Scene scene = grid_with_every_light();
    RenderSettings settings = small_settings(150, 131, 400);
    settings.want.aovs = {"depth", "normal", "light-count", "cluster"};
    settings.band_rows = FINE_TILE;
    for (const Geometry geometry : {Geometry::compute, Geometry::ids, Geometry::planes}) {
        settings.geometry = geometry;
        expect_same_in_strips(scene, settings);
    }
    settings.want.aovs.clear();
    settings.geometry = Geometry::compute;
    settings.band_rows = 0;
    settings.samples = 3;
    settings.shadows = Shadows::exact;
    settings.background = std::make_shared<const Environment>(Environment{1, 1, {glm::vec3(1.0f)}});
    expect_same_in_strips(scene, settings);
    settings.renderer = RendererKind::deferred_all;
    expect_same_in_strips(scene, settings);
}

TEST(Strips, HaveTheBitsOfBlendedSurfaces) {
    Scene scene = make_generated_scene("grid");
    scene.materials[0].alpha_mode = AlphaMode::blend;
    scene.materials[0].base_color.w = 0.5f;
    RenderSettings settings = small_settings(48, kRasterRows + 100, 50);
    settings.want.strip_makers = 1;
    settings.geometry = Geometry::ids;
    Renderer renderer(scene, settings);
    const Camera camera = first_camera(scene);
    const Frame whole = renderer.render(camera, 0.5);
    for (const Band& rows : {Band{kRasterRows, 100}, Band{0, kRasterRows}}) {
        const Frame strip = renderer.render_strip(camera, 0.5, rows);
        EXPECT_TRUE(strip.radiance == rows_of(whole.radiance, strip, 3));
        EXPECT_TRUE(strip.display == rows_of(whole.display, strip, 4));
    }
    scene.materials[0].base_color.w = 0.4f;
    Renderer other(scene, settings);
    EXPECT_FALSE(other.render(camera, 0.5).radiance == whole.radiance) << "nothing blends";
}

bool is_drawn(const Frame& frame) {
    return std::ranges::any_of(frame.stats.stages,
                               [](const StageTime& stage) { return stage.name == "geometry"; });
}

// As alpha makes strips: OpenGL draws their tile once for both backgrounds.
TEST(Strips, BeforeTwoBackgroundsAreDrawnOnce) {
    const Scene scene = make_generated_scene("grid");
    RenderSettings black = small_settings(96, 128, 100);
    black.geometry = Geometry::ids;
    RenderSettings white = black;
    white.background = std::make_shared<const Environment>(Environment{1, 1, {glm::vec3(1.0f)}});
    white.want = radiance_only();
    const Camera camera = first_camera(scene);
    const Frame on_black = render_once(scene, black), on_white = render_once(scene, white);
    Renderer renderer(scene, black);
    for (const Band& rows : {Band{0, 64}, Band{64, 64}}) {
        renderer.change(black);
        const Frame first = renderer.render_strip(camera, 0.0, rows);
        EXPECT_EQ(is_drawn(first), rows.first_row == 0);
        EXPECT_TRUE(first.radiance == rows_of(on_black.radiance, first, 3));
        renderer.change(white);
        const Frame second = renderer.render_strip(camera, 0.0, rows);
        EXPECT_FALSE(is_drawn(second));
        EXPECT_TRUE(second.radiance == rows_of(on_white.radiance, second, 3));
    }
    RenderSettings wider = white;
    wider.width = 112;
    renderer.change(wider);
    EXPECT_TRUE(is_drawn(renderer.render_strip(camera, 0.0, {64, 64}))) << "another picture";
}

TEST(Strips, AreRefusedWhereThePictureIsNeeded) {
    const Scene scene = make_generated_scene("plain");
    RenderSettings settings = small_settings(64, 64, 10);
    settings.bloom = 0.1f;
    Renderer renderer(scene, settings);
    const auto strip = [&] { renderer.render_strip(first_camera(scene), 0.0, {0, 32}); };
    EXPECT_THROW(strip(), Error);
    settings.bloom = 0.0f;
    settings.want.view = ViewKind::lights;
    renderer.change(settings);
    EXPECT_THROW(strip(), Error);
    settings.want.view = ViewKind::lit;
    renderer.change(settings);
    EXPECT_NO_THROW(strip());
}

MemoryPlan plan_of_size(int width, int height, std::uint64_t memory, int strip_makers,
                        std::uint64_t crop_pixels = 0) {
    const Scene scene = make_generated_scene("plain");
    RenderSettings settings = small_settings(width, height, 1000);
    settings.geometry = Geometry::compute;
    settings.max_memory_bytes = memory;
    settings.want.strip_makers = strip_makers;
    settings.want.crop_pixels = crop_pixels;
    return plan_memory(scene, settings, make_scene_plan(scene, settings, 1000),
                       describe(choose_device(settings.device)), true);
}

TEST(Strips, LetPicturesFitThatDoNotFitAsAWhole) {
    EXPECT_THROW(plan_of_size(65536, 65536, 2 * kGiB, 0), Error);
    const MemoryPlan plan = plan_of_size(65536, 65536, 2 * kGiB, 1);
    EXPECT_EQ(plan.strip_rows % 32, 0);
    EXPECT_GE(plan.strip_rows, plan.band_rows);
    EXPECT_LE(plan.bytes, 2 * kGiB);
    EXPECT_LE(65536u * static_cast<std::uint64_t>(plan.strip_rows), kStripPixels);
    EXPECT_THROW(plan_of_size(65536, 65536, 300 * kMebibyte, 1), Error);
}

// A crop of a picture in strips is held beside them.
TEST(Crops, TakeTheMemoryOfTheirPixels) {
    constexpr std::uint64_t kPixels = std::uint64_t{1} << 28, kRadiance = 3 * sizeof(float);
    const MemoryPlan strips = plan_of_size(65536, 65536, 32 * kGiB, 1);
    const MemoryPlan crop = plan_of_size(65536, 65536, 32 * kGiB, 1, kPixels);
    EXPECT_GE(crop.bytes, strips.bytes + kPixels * kRadiance);
    EXPECT_EQ(crop.strip_rows, strips.strip_rows);
    EXPECT_THROW(plan_of_size(65536, 65536, 2 * kGiB, 1, kPixels), Error);
}

TEST(Strips, AreThoseOfLargePicturesOnly) {
    EXPECT_EQ(plan_of_size(1920, 1080, 2 * kGiB, 1).strip_rows, 1080);
    EXPECT_EQ(plan_of_size(16384, 4096, 32 * kGiB, 1).strip_rows, 4096);
    EXPECT_EQ(plan_of_size(16384, 8192, 32 * kGiB, 0).strip_rows, 8192);
    EXPECT_EQ(plan_of_size(16384, 8192, 32 * kGiB, 1).strip_rows, 1024);
    EXPECT_EQ(plan_of_size(16384, 8192, 32 * kGiB, 4).strip_rows, 256) << "for each of four";
    // Four strips of the least rows are held: that is more than the whole.
    EXPECT_EQ(plan_of_size(65536, 64, 2 * kGiB, 1).strip_rows, 64);
}

// Bands and lists get most of the memory: more of it never leaves them much less.
TEST(Strips, LeaveMemoryToBandsAndLists) {
    std::uint64_t former = 0;
    for (std::uint64_t memory = 400; memory < 8192; memory += 50) {
        const std::uint64_t bytes = plan_of_size(8192, 8192, memory * kMebibyte, 1).device_bytes;
        EXPECT_GT(bytes, former / 2) << memory << " MiB";
        former = bytes;
    }
}

// Where nothing was measured OpenGL draws, as wide as it can.
TEST(Strips, OfPicturesTooWideForOpenGlAreDrawnByOpenCl) {
    const Scene scene = make_generated_scene("plain");
    const RenderScene drawn(scene, true);
    RenderSettings settings = small_settings(64, 64, 10);
    Tuning tuning;
    tuning.geometry = 0;
    if (drawn.opengl_limit() == 0) GTEST_SKIP() << "no OpenGL";
    EXPECT_FALSE(draws_in_opencl(drawn, settings, tuning));
    settings.width = drawn.opengl_limit() + 1;
    EXPECT_TRUE(draws_in_opencl(drawn, settings, tuning));
    settings.geometry = Geometry::ids;
    EXPECT_FALSE(draws_in_opencl(drawn, settings, tuning));
    settings.geometry = Geometry::automatic;
    settings.renderer = RendererKind::forward;
    EXPECT_FALSE(draws_in_opencl(drawn, settings, tuning));
}

}  // namespace
}  // namespace kilolux
