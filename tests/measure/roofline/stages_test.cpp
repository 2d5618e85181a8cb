// SPDX-License-Identifier: Apache-2.0
// Every stage that a frame takes time for is declared, so that tables sum it and limits know it.
#include "host/measure/roofline/stages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "host/scene/generated/scenes.h"
#include "tests/support/paths.h"
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
    settings.samples = 1;
    settings.auto_samples = {true, 0.01f, 32};
    expect_declared(settings);
}

TEST(Stages, OfForwardFramesAreDeclared) {
    RenderSettings settings = small_settings(64, 36, 60);
    for (const RendererKind renderer : {RendererKind::forward, RendererKind::forward_plus}) {
        settings.renderer = renderer;
        expect_declared(settings);
    }
}

// A kernel belongs to the stage with whose name its own begins, or to another one that launches it.
TEST(Stages, HaveEveryKernel) {
    const std::map<std::string, std::string> launched_by = {
        {"store_lights", "shade"},        {"drift_lights", "move_lights"},
        {"keep_shadows", "cast_shadows"}, {"order_tiles", "cast_shadows"},
        {"prefix_sum", "cull_lights"},    {"tail_bound", "tail_errors"},
        {"tail_moments", "tail_errors"},  {"tail_variance", "tail_errors"},
        {"tree_bound", "tail_errors"},    {"tree_cones", "cut_light_tree"},
        {"measure_limits", ""},           {"measure_texels", ""}};  // of no picture
    std::size_t kernels = 0;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(source_root() + "/kernels")) {
        if (entry.path().extension() != ".cl") continue;
        ++kernels;
        const std::string kernel = entry.path().stem().string();
        const auto other = launched_by.find(kernel);
        if (other != launched_by.end() && other->second.empty()) continue;
        const std::string stage = other != launched_by.end() ? other->second : kernel;
        EXPECT_TRUE(std::ranges::any_of(all_stages(), [&](const StageInfo* info) {
            return stage.starts_with(info->name);
        })) << kernel;
    }
    EXPECT_GT(kernels, 40u);
}

}  // namespace
}  // namespace kilolux
