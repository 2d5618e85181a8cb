// SPDX-License-Identifier: Apache-2.0
// --samples auto: edges, sampled shadows and random ranges to a given error, the same bits every
// way.
#include <cmath>

#include "host/base/system/interrupt.h"
#include "host/picture/sample_pattern.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

RenderSettings auto_settings(int width, int height, float error, int most) {
    RenderSettings settings = small_settings(width, height, 200);
    settings.auto_samples = {true, error, most};
    settings.want.display = false;
    return settings;
}

double rec709_of(const std::vector<float>& rgb, std::size_t pixel) {
    const float* c = &rgb[3 * pixel];
    return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
}

// Mean over the pixels of (x - r)^2 / (r^2 + floor^2).
double squared_error(const std::vector<float>& seen, const std::vector<float>& reference) {
    double sum = 0.0;
    for (std::size_t i = 0; i < seen.size() / 3; ++i) {
        const double r = rec709_of(reference, i);
        const double d = rec709_of(seen, i) - r;
        sum += d * d / (r * r + kSampleErrorFloor * kSampleErrorFloor);
    }
    return sum / (static_cast<double>(seen.size()) / 3.0);
}

double mean_count(const FrameStats& stats) {
    return static_cast<double>(stats.samples.total) / static_cast<double>(stats.samples.pixels);
}

TEST(AutoSamples, TheLeastIsTheMeanOfEightSamples) {
    const Scene scene = make_generated_scene("grid");
    const RenderSettings settings = auto_settings(70, 37, 1e6f, 1024);
    const Frame frame = render_once(scene, settings, 0.5);
    RenderSettings fixed = settings;
    fixed.auto_samples.on = false;
    fixed.samples = 8;
    const Frame eight = render_once(scene, fixed, 0.5);
    for (std::size_t i = 0; i < frame.radiance.size(); ++i) {
        ASSERT_NEAR(frame.radiance[i], eight.radiance[i], 1e-6 * eight.radiance[i]) << i;
    }
    const SampleCounts& counts = frame.stats.samples;
    EXPECT_EQ(counts.total, 8u * 70 * 37);
    EXPECT_EQ(counts.pixels, 70u * 37);
    EXPECT_EQ(counts.least, 8u);
    EXPECT_EQ(counts.most, 8u);
    EXPECT_EQ(counts.tiles, 15u);
    EXPECT_EQ(counts.open_tiles, 0u);
    EXPECT_EQ(eight.stats.samples.total, 0u);
    EXPECT_EQ(frame.stats.refined_pairs, eight.stats.refined_pairs) << "counts are the centre's";
}

// With edges, shadows and ranges at once, the picture is as near to one of many samples as asked
// for.
TEST(AutoSamples, ThePictureIsAsNearAsAsked) {
    Scene scene = grid_with_every_light();
    for (SceneLight& light : scene.lights) light.range = 0.0f;
    for (const float error : {0.1f, 0.04f}) {
        RenderSettings settings = auto_settings(96, 64, error, 4096);
        settings.geometry = error < 0.05f ? Geometry::compute : Geometry::ids;
        settings.shadows = Shadows::sampled;
        settings.shadow_rays = 1;
        settings.tails = Tails::stochastic;
        settings.range_budget = 0.05;
        const Frame frame = render_once(scene, settings);
        RenderSettings many = settings;
        many.auto_samples.on = false;
        many.samples = 600;
        many.seed = 77;
        const Frame reference = render_once(scene, many);
        EXPECT_EQ(frame.stats.samples.open_tiles, 0u);
        EXPECT_GT(frame.stats.samples.most, 2 * frame.stats.samples.least);
        const double seen = std::sqrt(squared_error(frame.radiance, reference.radiance));
        EXPECT_LT(seen, error) << mean_count(frame.stats) << " samples a pixel";
        EXPECT_GT(seen, 0.1 * error) << mean_count(frame.stats) << " samples a pixel";
    }
}

TEST(AutoSamples, HaveTheSameBitsEveryWay) {
    const Scene scene = grid_with_every_light();
    RenderSettings settings = auto_settings(70, 60, 0.05f, 64);
    settings.shadows = Shadows::sampled;
    settings.want.aovs = {"error-standard", "sample-count"};
    const Frame frame = render_once(scene, settings);
    EXPECT_GT(frame.stats.samples.most, frame.stats.samples.least);
    const auto expect_same = [&](const RenderSettings& other, const char* what) {
        const Frame seen = render_once(scene, other);
        EXPECT_EQ(seen.radiance, frame.radiance) << what;
        EXPECT_EQ(seen.aovs[0].values, frame.aovs[0].values) << what;
        EXPECT_EQ(seen.aovs[1].ids, frame.aovs[1].ids) << what;
        EXPECT_EQ(seen.stats.samples.total, frame.stats.samples.total) << what;
        EXPECT_EQ(seen.stats.samples.open_tiles, frame.stats.samples.open_tiles) << what;
    };
    RenderSettings other = settings;
    other.renderer = RendererKind::deferred_all;
    expect_same(other, "deferred-all");
    other = settings;
    other.band_rows = FINE_TILE;
    expect_same(other, "bands");
    other = settings;
    other.grid = {5, 3, 2, 8};
    expect_same(other, "another grid");
    other = settings;
    other.kernels.lanes = 1;
    expect_same(other, "one lane");
    other = settings;
    other.no_reuse = true;
    expect_same(other, "nothing kept");
}

// The picture is the same from a renderer with and without such pictures before, and with frames of
// fixed counts between.
TEST(AutoSamples, LeaveNothingBehind) {
    const Scene scene = make_generated_scene("grid");
    const RenderSettings settings = auto_settings(70, 37, 0.05f, 64);
    const Camera camera = first_camera(scene);
    Renderer renderer(scene, settings);
    const Frame first = renderer.render(camera, 0.5);
    EXPECT_EQ(renderer.render(camera, 0.5).radiance, first.radiance);
    RenderSettings one = settings;
    one.auto_samples.on = false;
    renderer.change(one);
    EXPECT_EQ(renderer.render(camera, 0.5).radiance, render_once(scene, one, 0.5).radiance);
    renderer.change(settings);
    EXPECT_EQ(renderer.render(camera, 0.5).radiance, first.radiance);
}

TEST(AutoSamples, LayersAreTheCentresAndTheMeansError) {
    const Scene scene = make_generated_scene("grid");
    constexpr float kError = 0.05f;
    RenderSettings settings = auto_settings(70, 37, kError, 1024);
    settings.want.aovs = {"depth", "normal", "light-count", "sample-count", "error-standard"};
    const Frame frame = render_once(scene, settings);
    RenderSettings one = settings;
    one.auto_samples.on = false;
    one.want.aovs = {"depth", "normal", "light-count"};
    const Frame centre = render_once(scene, one);
    for (std::size_t i = 0; i < centre.aovs.size(); ++i) {
        EXPECT_EQ(frame.aovs[i].values, centre.aovs[i].values) << centre.aovs[i].name;
        EXPECT_EQ(frame.aovs[i].ids, centre.aovs[i].ids) << centre.aovs[i].name;
    }
    const std::vector<std::uint32_t>& taken = frame.aovs[3].ids;
    const auto [least, most] = std::ranges::minmax(taken);
    EXPECT_EQ(least, frame.stats.samples.least);
    EXPECT_EQ(most, frame.stats.samples.most);
    EXPECT_GT(most, least);
    EXPECT_EQ(frame.stats.samples.open_tiles, 0u);
    double sum = 0.0;
    for (std::size_t i = 0; i < taken.size(); ++i) {
        const double l = rec709_of(frame.radiance, i);
        sum += std::pow(frame.aovs[4].values[i], 2.0) /
               (l * l + kSampleErrorFloor * kSampleErrorFloor);
    }
    EXPECT_LT(std::sqrt(sum / static_cast<double>(taken.size())), kError);
    EXPECT_GT(std::ranges::max(frame.aovs[4].values), 0.0f);
}

TEST(AutoSamples, ExposureMovesTheFloor) {
    const Scene scene = make_generated_scene("grid");
    RenderSettings settings = auto_settings(70, 37, 0.02f, 256);
    settings.exposure = -10.0f;
    const Frame dark = render_once(scene, settings);
    EXPECT_EQ(dark.stats.samples.most, 8u) << "everything is much darker than the floor";
    settings.exposure = 0.0f;
    EXPECT_GT(render_once(scene, settings).stats.samples.most, 8u);
}

TEST(AutoSamples, TheMostIsKeptAndTold) {
    const Scene scene = make_generated_scene("grid");
    const Frame frame = render_once(scene, auto_settings(70, 37, 1e-6f, 13));
    EXPECT_EQ(frame.stats.samples.most, 12u) << "two halves of six";
    EXPECT_GT(frame.stats.samples.open_tiles, 0u);
}

TEST(AutoSamples, TilesThatAreDoneAreNotShaded) {
    const Scene scene = make_generated_scene("grid");
    const Frame frame = render_once(scene, auto_settings(70, 37, 0.02f, 64));
    const auto is_mask = [](const StageTime& stage) { return stage.name == "mask_tiles"; };
    EXPECT_TRUE(std::ranges::any_of(frame.stats.stages, is_mask));
}

TEST(AutoSamples, ForwardRenderersAndPlanesHaveThem) {
    const Scene scene = make_generated_scene("grid");
    RenderSettings settings = auto_settings(70, 37, 0.05f, 64);
    const Frame frame = render_once(scene, settings);
    settings.geometry = Geometry::planes;
    const Frame planes = render_once(scene, settings);
    EXPECT_LT(std::sqrt(squared_error(planes.radiance, frame.radiance)), 0.1);
    EXPECT_GT(planes.stats.samples.most, planes.stats.samples.least);
    settings = auto_settings(70, 37, 0.05f, 64);
    settings.renderer = RendererKind::forward_plus;
    const Frame forward = render_once(scene, settings);
    EXPECT_LT(std::sqrt(squared_error(forward.radiance, frame.radiance)), 0.1);
}

// A long picture can be cancelled between its samples, without effect on later ones.
TEST(AutoSamples, CanBeLeftBetweenSamples) {
    const Scene scene = make_generated_scene("grid");
    const Camera camera = first_camera(scene);
    Renderer renderer(scene, auto_settings(70, 37, 0.05f, 64));
    const Frame first = renderer.render(camera, 0.0);
    int calls = 0;
    {
        const WorkWatch leave([&](double) {
            if (++calls == 12) throw Interrupted();
        });
        EXPECT_THROW(renderer.render(camera, 0.0), Interrupted);
    }
    EXPECT_EQ(renderer.render(camera, 0.0).radiance, first.radiance);
}

}  // namespace
}  // namespace kilolux
