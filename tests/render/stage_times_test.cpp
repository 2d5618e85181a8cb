// SPDX-License-Identifier: Apache-2.0
// A frame's stages and idle time sum to the frame, the first frame's too: it repeats stages whose
// results had no room.
#include <gtest/gtest.h>

#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

// What the stages leave of the frame [ms].
double rest_of(const FrameStats& stats) {
    double ms = stats.frame_ms + stats.overlap_ms;
    for (const StageTime& stage : stats.stages) {
        EXPECT_GE(stage.ms, 0.0) << stage.name;
        ms -= stage.ms;
    }
    return ms;
}

void expect_sums(RendererKind renderer, Shadows shadows, Geometry geometry) {
    const Scene scene = make_generated_scene("atrium");
    RenderSettings settings = small_settings(160, 90, 2000);
    settings.renderer = renderer;
    settings.shadows = shadows;
    settings.geometry = geometry;
    Renderer made(scene, settings);
    for (int i = 0; i < 3; ++i) {
        const Frame frame = made.render(first_camera(scene), 0.1 * i);
        constexpr double kClockMs = 0.01;  // between readings of the clock
        EXPECT_GE(rest_of(frame.stats), -kClockMs) << "frame " << i;
        EXPECT_GE(frame.stats.overlap_ms, -kClockMs) << "frame " << i;
        EXPECT_LT(frame.stats.overlap_ms, frame.stats.frame_ms) << "frame " << i;
    }
}

TEST(StageTimes, SumToTheFrame) {
    expect_sums(RendererKind::deferred, Shadows::off, Geometry::ids);
}

TEST(StageTimes, SumToTheFrameWhereTheHostMakesAShadowScene) {
    expect_sums(RendererKind::deferred, Shadows::exact, Geometry::ids);
    expect_sums(RendererKind::deferred, Shadows::exact, Geometry::compute);
}

TEST(StageTimes, SumToTheFrameWhereOpenGlShades) {
    expect_sums(RendererKind::forward, Shadows::off, Geometry::ids);
    expect_sums(RendererKind::forward_plus, Shadows::off, Geometry::ids);
}

}  // namespace
}  // namespace kilolux
