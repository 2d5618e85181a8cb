// SPDX-License-Identifier: Apache-2.0
// Gains of groups of lights: the picture is that of a scene whose lights have other intensities.
#include <functional>
#include <map>

#include "host/render/lights/light_source.h"
#include "tests/render/lights/named_grid.h"

namespace kilolux {
namespace {

// A file that gives the intensities of kGains. Powers of two round like the product of all others.
constexpr const char* kGains = "left=2:1,0.5,0.25,sun=0.5,swarm=4";
struct Changed {
    Scene scene;
    RenderSettings settings;
};
Changed changed_by_hand(Scene scene, RenderSettings settings) {
    for (SceneLight& light : scene.lights) {
        if (light.node == 0) light.intensity *= glm::vec3(2.0f, 1.0f, 0.5f);
        if (!kind_of(light).is_placed) light.intensity *= 0.5f;
    }
    settings.lights.intensity *= 4.0;
    return {std::move(scene), settings};
}

RenderSettings swarm_settings() {
    RenderSettings settings = small_settings();
    settings.lights.intensity = 0.75;  // that of the file's picture is four times it
    return settings;
}

// That the mix of kGains has the bits of the scene with these intensities.
void expect_other_intensities(const Scene& scene, const RenderSettings& settings) {
    const Changed changed = changed_by_hand(scene, settings);
    const Frame expected = render_once(changed.scene, changed.settings);
    const Frame frame = render_once(scene, mixed(scene, settings, kGains));
    EXPECT_EQ(frame.radiance, expected.radiance);
    EXPECT_NE(frame.radiance, render_once(scene, settings).radiance);
    EXPECT_TRUE(frame.aovs.empty()) << "no layers were asked for";
}

TEST(LightMix, IsAnotherIntensityInEveryRenderer) {
    const Scene scene = named_grid();
    RenderSettings settings = swarm_settings();
    for (const RendererKind renderer : {RendererKind::deferred, RendererKind::deferred_all,
                                        RendererKind::forward_plus, RendererKind::forward}) {
        SCOPED_TRACE(static_cast<int>(renderer));
        settings.renderer = renderer;
        expect_other_intensities(scene, settings);
    }
}

TEST(LightMix, IsAnotherIntensityInEveryShadowAndSample) {
    const Scene scene = named_grid();
    for (const Shadows shadows : {Shadows::exact, Shadows::sampled}) {
        RenderSettings settings = swarm_settings();
        settings.shadows = shadows;
        expect_other_intensities(scene, settings);
        settings.auto_samples = {true, 0.2f, 16};
        settings.band_rows = 16;
        expect_other_intensities(scene, settings);
    }
}

// Ranges, their random weights and nodes of the tree follow from intensities.
TEST(LightMix, IsAnotherIntensityOfLightsWithoutARange) {
    Scene scene = named_grid();
    for (SceneLight& light : scene.lights) light.range = 0.0f;
    for (std::size_t i = 0; i < 6; ++i) scene.lights[i].type = LightType::point;
    for (const Tails tails : {Tails::exact, Tails::bounded, Tails::stochastic, Tails::tree}) {
        SCOPED_TRACE(static_cast<int>(tails));
        RenderSettings settings = swarm_settings();
        settings.tails = tails;
        settings.samples = tails == Tails::stochastic ? 3 : 1;
        settings.range_budget = tails == Tails::exact ? kDefaultRangeBudget : 0.05;
        expect_other_intensities(scene, settings);
    }
}

TEST(LightMix, OfOneChangesNoBit) {
    const Scene scene = named_grid();
    const RenderSettings settings = swarm_settings();
    EXPECT_EQ(render_once(scene, mixed(scene, settings, "left=1,swarm=1:1,1,1,rest=1")).radiance,
              render_once(scene, settings).radiance);
}

// A factor of two rounds nothing. The rest is what the groups leave of the picture, so it has the
// rounding of the picture's sum.
TEST(LightMix, IsInTheLayers) {
    const Scene scene = named_grid();
    const RenderSettings settings = grouped(scene, small_settings());
    const Frame plain = render_once(scene, settings);
    const Frame frame = render_once(scene, mixed(scene, settings, "left=2,swarm=0"));
    std::vector<double> sum(frame.radiance.size());
    for (const Layer& layer : frame.aovs) {
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += layer.values[i];
        const std::string group = layer.name.substr(std::string(kLightLayers).size());
        const float factor = group == "left" ? 2.0f : group == "swarm" ? 0.0f : 1.0f;
        std::vector<float> expected = layer_of(plain, group).values;
        for (float& value : expected) value *= factor;
        if (group == "rest") continue;
        EXPECT_EQ(layer.values, expected) << group;
    }
    for (std::size_t i = 0; i < sum.size(); ++i) {
        ASSERT_NEAR(sum[i], frame.radiance[i], 1e-6 * frame.radiance[i]) << i;
        ASSERT_NEAR(layer_of(frame, "rest").values[i], layer_of(plain, "rest").values[i],
                    1e-6 * (frame.radiance[i] + plain.radiance[i]))
            << i;
    }
}

// One renderer shows each mix, between frames of other times and cameras, as a fresh one does.
TEST(LightMix, FollowsEveryChange) {
    Scene scene = named_grid();
    scene.lights[0].follows_camera = true;
    scene.lights[0].position = {0.5, 0.0, 0.0};
    for (std::size_t i = 1; i < 6; ++i) {
        scene.lights[i].type = LightType::point;
        scene.lights[i].range = 0.0f;
    }
    for (const Tails tails : {Tails::bounded, Tails::tree}) {
        RenderSettings settings = swarm_settings();
        settings.tails = tails;
        Renderer renderer(scene, settings);
        double time = 0.0;
        for (const char* gains : {"left=2", "none", "left=0,swarm=0", "swarm=3:1,0,0.5", "rest=7",
                                  "swarm=0.125", "left=0,right=0,sun=0,swarm=0"}) {
            const RenderSettings next = mixed(scene, settings, gains);
            renderer.change(next);
            for (int i = 0; i < 2; ++i) {
                EXPECT_EQ(renderer.render(first_camera(scene), time).radiance,
                          render_once(scene, next, time).radiance)
                    << gains << " at " << time;
                if (i == 0) time += 0.7;
            }
        }
    }
}

// Lights of gain 0 cost nothing: they are as good as not there.
TEST(LightMix, LeavesOutMutedLights) {
    const Scene scene = named_grid();
    RenderSettings settings = small_settings();
    const FrameStats all = render_once(scene, settings).stats;
    const Frame frame = render_once(scene, mixed(scene, settings, "left=0,swarm=0"));
    EXPECT_EQ(frame.stats.lights_used, all.lights_used - 6 - settings.lights.count);
    EXPECT_EQ(frame.stats.lights_given, all.lights_given);
    settings.lights.count = 0;
    Scene rest = scene;
    std::erase_if(rest.lights, [](const SceneLight& light) { return light.node == 0; });
    EXPECT_EQ(frame.radiance, render_once(rest, settings).radiance);
    const Frame dark = render_once(scene, mixed(scene, settings, "left=0,right=0,sun=0",
                                                "left=left,right=right,sun=kind:directional"));
    EXPECT_EQ(dark.stats.lights_used, 0u);
}

TEST(LightMix, IsOfGeneratedLightsWithASize) {
    const Scene scene = named_grid();
    RenderSettings settings = swarm_settings();
    settings.shading = Shading::pbr;
    settings.lights.size = 0.05;
    expect_other_intensities(scene, settings);
    const Frame mute = render_once(scene, mixed(scene, settings, "swarm=0"));
    settings.lights.count = 0;
    EXPECT_EQ(mute.radiance, render_once(scene, settings).radiance);
}

// What references in float64 are made of.
TEST(LightMix, IsInTheLightsOfReferences) {
    const Scene scene = named_grid();
    const RenderSettings settings = mixed(scene, small_settings(), "right=3,swarm=0.5");
    const std::vector<SceneLight> plain = lights_at(scene, small_settings(), {}, 0.25);
    const std::vector<SceneLight> lights = lights_at(scene, settings, {}, 0.25);
    ASSERT_EQ(lights.size(), plain.size());
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const bool is_own = i < scene.lights.size();
        const float factor = !is_own ? 0.5f : scene.lights[i].node == 1 ? 3.0f : 1.0f;
        EXPECT_EQ(lights[i].intensity, factor * plain[i].intensity) << i;
    }
}

// The same numbers as group_of(), whatever has changed since the last call.
TEST(GroupNumbers, FollowLightsAndGroups) {
    Scene scene = named_grid();
    scene.webs.resize(2);
    scene.webs[1].name = "wide";
    scene.aimed_profiles = {{0, false}, {1, false}};
    std::vector<LightGroup> groups =
        parse_light_groups("", "left=left,web=ies:wide,sun=kind:directional,glow=from:surfaces");
    GroupNumbers numbers;
    const auto expect = [&](std::size_t light, int group) {
        EXPECT_EQ(numbers.of(scene, groups)[light], group);
        for (std::size_t i = 0; i < scene.lights.size(); ++i) {
            EXPECT_EQ(numbers.of(scene, groups)[i], group_of(scene.lights[i], scene, groups)) << i;
        }
    };
    expect(1, 0);
    scene.lights[1].node = 0;
    expect(1, 1);
    scene.lights[1].node = 1;
    scene.lights[1].profile = 1;
    expect(1, 2);
    scene.lights[1].profile = 0;
    expect(1, 0);
    scene.lights[1].type = LightType::directional;
    expect(1, 3);
    scene.lights[1].type = LightType::triangle;
    scene.lights[1].of_surface = true;
    expect(1, 4);
    scene.lights.erase(scene.lights.begin());
    expect(0, 4);
    groups = parse_light_groups("", "right=right");
    expect(0, 1);
    scene.lights.insert(scene.lights.begin(), 3, SceneLight());
    expect(0, 0);
}

TEST(LightMixText, IsReadAndWritten) {
    EXPECT_TRUE(parse_light_mix("", "none").empty());
    const auto gains = parse_light_mix("--light-mix", "key=2:1,0.5,0.25,fill=+0,rest=1e-3:#ff8000");
    ASSERT_EQ(gains.size(), 3u);
    EXPECT_EQ(gains[0], (GroupGain{"key", 2.0f, {1.0f, 0.5f, 0.25f}}));
    EXPECT_EQ(gains[1], (GroupGain{"fill", 0.0f}));
    EXPECT_FLOAT_EQ(gains[2].color.y, 0.21586050f) << "linear";
    EXPECT_EQ(gains[2].color.x, 1.0f);
    EXPECT_EQ(gains[0].factors(), glm::vec3(2.0f, 1.0f, 0.5f));
    EXPECT_EQ(text_of(parse_light_mix("", "a=0.1,b=2:1,0.5,0")), "a=0.1,b=2:1,0.5,0");
    EXPECT_EQ(parse_light_mix("", text_of(gains)), gains);
}

TEST(LightMixText, SaysWhatIsWrong) {
    const Scene scene = named_grid();
    const std::map<const char*, const char*> reasons = {
        {"left", "--light-mix: 'left' is not NAME=GAIN[:COLOR]"},
        {"=1", "'=1' is not NAME=GAIN"},
        {"left=", "'left=' has the gain '', which is not a finite number of at least 0"},
        {"left=-1", "has the gain '-1'"},
        {"left=inf", "has the gain 'inf'"},
        {"left=nan", "has the gain 'nan'"},
        {"left=1e39", "has the gain '1e39'"},
        {"left=1:red", "has the colour 'red', which is neither R,G,B"},
        {"left=1:1,2", "has the colour '1,2'"},
        {"left=1:1,2,-3", "has the colour '1,2,-3'"},
        {"left=1:1,2,3,4", "has the colour '1,2,3,4'"},
        {"left=1,left=2", "--light-mix: two gains of 'left'"},
        {"lef=1",
         "light mix: 'lef' is none of the light groups left, right, sun, swarm, rest; did "
         "you mean 'left'?"}};
    for (const auto& [gains, reason] : reasons) {
        const std::string message =
            message_of<UsageError>([&] { mixed(scene, small_settings(), gains); });
        EXPECT_TRUE(contains(message, reason)) << message;
    }
}

}  // namespace
}  // namespace kilolux
