// SPDX-License-Identifier: Apache-2.0
// Every stage that a frame takes time for is declared, so that tables sum it and limits know it.
#include "host/measure/roofline/stages.h"

#include <gtest/gtest.h>

#include "host/scene/generated/scenes.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

void expect_declared(const RenderSettings& settings) {
    const Scene scene = make_generated_scene("grid");
    const FrameStats stats = render_once(scene, settings).stats;
    EXPECT_GT(stats.stages.size(), 3u);
    for (const StageTime& stage : stats.stages)
        EXPECT_NE(stage_info(stage.name), nullptr) << stage.name;
}

TEST(Stages, OfFramesAreDeclared) {
    RenderSettings settings = small_settings(64, 36, 60);
    expect_declared(settings);
    settings.geometry = Geometry::compute;
    settings.shadows = Shadows::sampled;
    settings.bloom = 0.1f;
    settings.tone_curve = ToneCurve::aces;
    settings.samples = 2;
    expect_declared(settings);
}

TEST(Stages, OfForwardFramesAreDeclared) {
    RenderSettings settings = small_settings(64, 36, 60);
    for (const RendererKind renderer : {RendererKind::forward, RendererKind::forward_plus}) {
        settings.renderer = renderer;
        expect_declared(settings);
    }
}

}  // namespace
}  // namespace kilolux
