// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/setting.h"

#include <gtest/gtest.h>

#include <numbers>
#include <set>

#include "host/gpu/tuning/tuning_store.h"
#include "host/render/lights/light_source.h"
#include "host/render/plan/kernel_choice.h"
#include "host/render/plan/scene_plan.h"
#include "host/scene/generated/scenes.h"
#include "tests/support/cache_sandbox.h"

namespace kilolux {
namespace {

DeviceInfo report_device() {
    DeviceInfo out;
    out.is_cpu = true;
    out.lane_width = 8;
    out.compute_units = 2;
    out.max_work_group = 4096;
    return out;
}

using ReportSettingsOfATuning = TuningSandbox;

std::set<SettingAxis> axes(const std::vector<ReportSetting>& settings) {
    std::set<SettingAxis> out;
    for (const ReportSetting& setting : settings) out.insert(setting.axis);
    return out;
}

TEST(ReportSettings, CoverEveryAxisOnceEach) {
    const Scene scene = make_generated_scene("grid");
    for (const bool quick : {false, true}) {
        const auto settings = report_settings(scene, {}, report_device(), {.quick = quick});
        EXPECT_EQ(settings.front().name, "default");
        EXPECT_EQ(settings.front().options, "");
        EXPECT_EQ(axes(settings).size(), 9u);
        std::set<std::string> names;
        for (const ReportSetting& s : settings) EXPECT_TRUE(names.insert(s.name).second) << s.name;
        for (const char* name : {"gbuffer full", "gbuffer half", "gbuffer normal-xy",
                                 "gbuffer oct-2x4", "geometry planes", "math fast-relaxed",
                                 "math native", "light-colors half", "renderer deferred-all",
                                 "renderer forward-plus", "shading blinn-phong", "cut-off 1/256"}) {
            EXPECT_TRUE(names.count(name)) << name;
        }
        EXPECT_EQ(names.count("renderer forward"), quick ? 0u : 1u);
        EXPECT_FALSE(names.count("gbuffer packed")) << "that is the default";
    }
}

// Whatever --geometry auto is on the device, the axis has the other ways.
TEST_F(ReportSettingsOfATuning, HaveTheWaysThatAutomaticGeometryIsNot) {
    const Scene scene = make_generated_scene("grid");
    for (const int computes : {0, 1}) {
        StoredTuning tuning = choose_tuning(report_device(), {});
        tuning.tuning.geometry = computes;
        store_tuning(report_device(), tuning);
        std::set<std::string> names;
        for (const ReportSetting& s : report_settings(scene, {}, report_device(), {})) {
            if (s.axis == SettingAxis::geometry) names.insert(s.name);
        }
        const std::string other = computes == 1 ? "geometry ids" : "geometry compute";
        EXPECT_EQ(names, (std::set<std::string>{other, "geometry planes"}));
    }
}

TEST(ReportSettings, CutOffsKeepTheLightsAndSetTheirRange) {
    const Scene scene = make_generated_scene("grid");
    RenderSettings base;
    base.lights.count = 300;
    const double intensity = automatic_light_scale(base.lights, scene).intensity;
    for (const ReportSetting& s : report_settings(scene, base, report_device(), {})) {
        if (s.axis != SettingAxis::cut_off) continue;
        const LightScale scale = automatic_light_scale(s.settings.lights, scene);
        EXPECT_DOUBLE_EQ(scale.intensity, intensity) << s.name;
        const double budget = scale.intensity / (std::numbers::pi * scale.radius * scale.radius);
        EXPECT_NEAR(budget, s.settings.range_budget, 1e-12) << s.name;
        EXPECT_NEAR(cut_off_of(scene, s.settings), budget, 1e-12);
    }
}

// A file's lights: those with a range keep it, the others follow the budget.
TEST(ReportSettings, FilesLightsFollowTheBudgetWhereTheyHaveNoRange) {
    Scene scene = make_generated_scene("plain");
    RenderSettings base;
    base.lights.count = 0;
    EXPECT_EQ(axes(report_settings(scene, base, report_device(), {})).count(SettingAxis::cut_off),
              0u)
        << "no light has a range to choose";
    SceneLight ranged, open;
    ranged.intensity = open.intensity = {10.0f, 5.0f, 1.0f};
    ranged.range = 3.0f;
    scene.lights = {ranged, open};
    int cut_offs = 0;
    for (const ReportSetting& s : report_settings(scene, base, report_device(), {})) {
        if (s.axis != SettingAxis::cut_off) continue;
        ++cut_offs;
        const auto lights = lights_at(scene, s.settings, {}, 0.0);
        EXPECT_EQ(lights[0].range, 3.0f);
        EXPECT_FLOAT_EQ(lights[1].range,
                        static_cast<float>(range_of_light(10.0, s.settings.range_budget)));
    }
    EXPECT_EQ(cut_offs, 5) << "all bounded: the default is exact";
}

// Many lights without a range: the report tries all treatments beside cut-offs.
TEST(ReportSettings, ManyLightsWithoutARangeAreTriedInEveryWay) {
    Scene scene = make_generated_scene("plain");
    scene.lights.resize(200);
    RenderSettings base;
    base.lights.count = 0;
    const auto names = [&](const RenderSettings& asked, bool quick) {
        std::set<std::string> out;
        for (const ReportSetting& s :
             report_settings(scene, asked, report_device(), {.quick = quick})) {
            if (s.axis != SettingAxis::cut_off || s.name.starts_with("cut-off")) continue;
            out.insert(s.name);
            EXPECT_NO_THROW(make_scene_plan(scene, s.settings, 200)) << s.name;
        }
        return out;
    };
    using Names = std::set<std::string>;
    EXPECT_EQ(names(base, true), (Names{"tails exact", "tails stochastic 4", "tails tree 0.3"}));
    EXPECT_EQ(names(base, false),
              (Names{"tails exact", "tails stochastic 1", "tails stochastic 4",
                     "tails stochastic 16", "tails tree 0.01", "tails tree 0.03", "tails tree 0.1",
                     "tails tree 0.3", "tails tree 1"}));
    base.shadows = Shadows::exact;
    EXPECT_EQ(names(base, true), (Names{"tails exact", "tails stochastic 4"}));
    base.shadows = Shadows::off;
    base.tails = Tails::tree;
    EXPECT_EQ(names(base, false).count("tails tree 0.3"), 0u);
    for (const ReportSetting& s : report_settings(scene, base, report_device(), {})) {
        EXPECT_NO_THROW(make_scene_plan(scene, s.settings, 200)) << s.name;
    }
}

TEST(ReportSettings, ForwardRenderersHaveNoGBufferToVary) {
    RenderSettings base;
    base.renderer = RendererKind::forward_plus;
    const auto found = axes(
        report_settings(make_generated_scene("plain"), base, report_device(), {.quick = true}));
    EXPECT_FALSE(found.count(SettingAxis::gbuffer));
    EXPECT_FALSE(found.count(SettingAxis::lanes));
    EXPECT_FALSE(found.count(SettingAxis::math));
    EXPECT_TRUE(found.count(SettingAxis::grid));
}

std::set<std::string> names_with(Shadows shadows, const SettingChoice& choice,
                                 const Scene& scene = make_generated_scene("plain")) {
    RenderSettings base;
    base.shadows = shadows;
    std::set<std::string> names;
    for (const auto& s : report_settings(scene, base, report_device(), choice)) {
        names.insert(s.name);
        EXPECT_FALSE(is_forward(s.settings.renderer) && s.settings.shadows != Shadows::off)
            << s.name;
        EXPECT_TRUE(resolves_ids(s.settings.geometry) || s.settings.shadows == Shadows::off)
            << s.name;
        EXPECT_EQ(s.axis == SettingAxis::shadows, s.name.starts_with("shadows")) << s.name;
    }
    return names;
}

TEST(ReportSettings, ShadowsAreAnAxisWhereTheyAreAskedFor) {
    const auto exact = names_with(Shadows::exact, {});
    for (const char* name :
         {"shadows off", "shadows sampled 1", "shadows sampled 4", "shadows sampled 16"}) {
        EXPECT_TRUE(exact.count(name)) << name;
    }
    EXPECT_FALSE(exact.count("shadows exact")) << "that is the default";
    EXPECT_FALSE(exact.count("renderer forward-plus")) << "it casts none";
    EXPECT_FALSE(exact.count("geometry planes")) << "nor does this";
    const auto sampled = names_with(Shadows::sampled, {.shadow_rays = {4, 32}});
    EXPECT_TRUE(sampled.count("shadows exact"));
    EXPECT_TRUE(sampled.count("shadows sampled 32"));
    EXPECT_FALSE(sampled.count("shadows sampled 4")) << "that is the default";
    for (const std::string& name : names_with(Shadows::off, {})) {
        EXPECT_FALSE(name.starts_with("shadows")) << name;
    }
}

TEST(ReportSettings, SoftShadowsHaveEveryPowerOfTwoRays) {
    Scene scene = make_generated_scene("plain");
    scene.lights.resize(1);
    scene.lights.front().type = LightType::sphere;
    scene.lights.front().radius = 0.1f;
    scene.lights.front().range = 5.0f;
    const auto names = names_with(Shadows::sampled, {}, scene);
    for (const int rays : {1, 2, 8, 16, 32}) {
        EXPECT_TRUE(names.count("shadows sampled " + std::to_string(rays))) << rays;
    }
    EXPECT_FALSE(names.count("shadows sampled 4")) << "that is the default";
    EXPECT_FALSE(names.count("shadows exact")) << "there are none";
    EXPECT_FALSE(names_with(Shadows::sampled, {}).count("shadows sampled 2"));
}

}  // namespace
}  // namespace kilolux
