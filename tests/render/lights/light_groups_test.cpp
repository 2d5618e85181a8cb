// SPDX-License-Identifier: Apache-2.0
// Layers of the light of groups of lights.
#include <fmt/core.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "tests/render/lights/named_grid.h"
#include "tests/render/shadows/soft_scenes.h"
#include "tests/support/glass_pictures.h"

namespace kilolux {
namespace {

// The scene with only the lights for which `stays` holds; the others stay dark, in their places.
Scene only(Scene scene, const std::function<bool(const SceneLight&)>& stays) {
    for (SceneLight& light : scene.lights) {
        if (!stays(light)) light.intensity *= 1e-30f;
    }
    return scene;
}

// That the layers of all groups and of the rest add up to the picture, whose bits are those of a
// picture without groups, and that every group lights something.
Frame expect_whole(const Scene& scene, RenderSettings settings) {
    const Frame frame = render_once(scene, settings);
    // Of sampled shadows a layer may be negative: the sum rounds by its terms' magnitude.
    std::vector<double> sum(frame.radiance.size()), magnitude(sum.size());
    for (const Layer& layer : frame.aovs) {
        if (!layer.name.starts_with(kLightLayers)) continue;
        EXPECT_GT(*std::ranges::max_element(layer.values), 1e-4f) << layer.name;
        for (std::size_t i = 0; i < sum.size(); ++i) {
            sum[i] += layer.values[i];
            magnitude[i] += std::abs(layer.values[i]);
        }
    }
    for (std::size_t i = 0; i < sum.size(); ++i) {
        if (std::abs(sum[i] - frame.radiance[i]) > 1e-6 * magnitude[i]) {
            ADD_FAILURE() << i << ": " << sum[i] << ", not " << frame.radiance[i];
            break;
        }
    }
    settings.light_groups.clear();
    EXPECT_EQ(render_once(scene, settings).radiance, frame.radiance);
    return frame;
}

// The largest difference of a layer and what lights add to a picture without them, relative to the
// largest value of the layer.
double layer_error(const Layer& layer, const Frame& lit, const Frame& unlit) {
    double most = 0.0, error = 0.0;
    for (std::size_t i = 0; i < layer.values.size(); ++i) {
        const double added = double{lit.radiance[i]} - unlit.radiance[i];
        most = std::max<double>(most, layer.values[i]);
        error = std::max(error, std::abs(layer.values[i] - added));
    }
    return error / most;
}

TEST(LightGroups, AreThePicturesOfTheirLightsAlone) {
    const Scene scene = named_grid();
    RenderSettings settings = small_settings();
    settings.shading = Shading::pbr;
    const Frame frame = expect_whole(scene, grouped(scene, settings));
    const std::uint64_t swarm = std::exchange(settings.lights.count, 0);
    const auto none = [](const SceneLight&) { return false; };
    const Frame unlit = render_once(only(scene, none), settings);
    const auto expect_alone = [&](const char* group, const auto& stays) {
        const Frame lit = render_once(only(scene, stays), settings);
        EXPECT_LT(layer_error(layer_of(frame, group), lit, unlit), 2e-6) << group;
    };
    expect_alone("left", [](const SceneLight& light) { return light.node == 0; });
    expect_alone("right", [](const SceneLight& light) { return light.node == 1; });
    expect_alone("sun", [](const SceneLight& light) { return !kind_of(light).is_placed; });
    settings.lights.count = swarm;
    expect_alone("swarm", none);
}

TEST(LightGroups, ListsChangeNoBitOfThem) {
    const Scene scene = named_grid();
    for (const Shadows shadows : {Shadows::off, Shadows::exact, Shadows::sampled}) {
        RenderSettings settings = grouped(scene, small_settings());
        settings.shadows = shadows;
        const Frame listed = expect_whole(scene, settings);
        settings.renderer = RendererKind::deferred_all;
        settings.kernels.lanes = 4;
        const Frame all = render_once(scene, settings);
        for (std::size_t i = 0; i < listed.aovs.size(); ++i) {
            EXPECT_EQ(listed.aovs[i].values, all.aovs[i].values) << listed.aovs[i].name;
        }
    }
}

TEST(LightGroups, AreInSamplesAndBandsAlike) {
    const Scene scene = named_grid();
    RenderSettings settings = grouped(scene, small_settings());
    settings.samples = 3;
    const Frame whole = expect_whole(scene, settings);
    settings.band_rows = 16;
    const Frame banded = render_once(scene, settings);
    for (std::size_t i = 0; i < whole.aovs.size(); ++i) {
        EXPECT_EQ(whole.aovs[i].values, banded.aovs[i].values) << whole.aovs[i].name;
    }
}

// Kernels tell up to eight groups apart by comparisons, more by their place.
TEST(LightGroups, ManyAreTheSameAsOneAlone) {
    constexpr int kMany = 12;
    Scene scene = grid_with_every_light();
    std::string all;
    for (int i = 0; i < kMany; ++i) {
        scene.light_nodes.push_back({fmt::format("lamp{}", i), ""});
        all += fmt::format("{}lamp{}=lamp{}", i > 0 ? "," : "", i, i);
    }
    const std::size_t lights = scene.lights.size();
    for (std::size_t i = 0; i < kMany; ++i) {
        scene.lights.push_back(scene.lights[i % lights]);
        scene.lights.back().node = static_cast<int>(i);
    }
    RenderSettings settings = small_settings(96, 64, 0);
    settings.shading = Shading::pbr;
    const Frame many = expect_whole(scene, grouped(scene, settings, all.c_str()));
    for (int i = 0; i < kMany; i += 5) {
        const std::string name = fmt::format("lamp{}", i);
        const Frame one = render_once(scene, grouped(scene, settings, (name + "=" + name).c_str()));
        EXPECT_EQ(layer_of(many, name).values, layer_of(one, name).values) << name;
    }
}

TEST(LightGroups, WithAutomaticSamplesHaveThePicturesSamples) {
    const Scene scene = named_grid();
    RenderSettings settings = grouped(scene, small_settings(70, 60, 60));
    settings.shadows = Shadows::exact;
    settings.auto_samples = {true, 0.05f, 64};
    const Frame early = expect_whole(scene, settings);
    EXPECT_GT(early.stats.samples.most, early.stats.samples.least);
    settings.shadows = Shadows::sampled;
    settings.auto_samples = {true, 1e-9f, 16};  // all that vary take the most
    const Frame frame = render_once(scene, settings);
    settings.auto_samples.on = false;
    settings.samples = 16;
    const Frame fixed = render_once(scene, settings);
    for (const Layer& layer : fixed.aovs) {
        const float most = *std::ranges::max_element(layer.values);
        const std::string group = layer.name.substr(kLightLayers.size());
        const std::vector<float>& seen = layer_of(frame, group).values;
        for (std::size_t i = 0; i < seen.size(); ++i) {
            ASSERT_NEAR(seen[i], layer.values[i], 1e-5 * most) << group << ' ' << i;
        }
    }
}

TEST(LightGroups, OfGlassAreWhatIsSeenThroughIt) {
    Scene scene = glass_scene();
    scene.light_nodes = {{"near", ""}};
    for (std::size_t i = 0; i < scene.lights.size(); i += 3) scene.lights[i].node = 0;
    RenderSettings settings = small_settings(96, 64, 0);
    for (const Shadows shadows : {Shadows::off, Shadows::exact}) {
        settings.shadows = shadows;
        expect_whole(scene, grouped(scene, settings, "near=near"));
    }
}

TEST(LightGroups, OfLightsWithASizeHaveTheirSoftShadows) {
    Scene scene = board_below(panel(LightType::rectangle)).scene;
    scene.lights.push_back(panel(LightType::sphere));
    scene.lights.back().position += glm::dvec3(1.5, 0.0, 0.5);
    RenderSettings settings =
        grouped(scene, soft_settings(48, 27, 4), "flat=kind:rect,round=kind:sphere");
    settings.ambient = 0.1f;  // the rest
    expect_whole(scene, settings);
}

TEST(LightGroups, FollowAChangeOfGroups) {
    const Scene scene = named_grid();
    RenderSettings settings = grouped(scene, small_settings(), "a=left");
    Renderer renderer(scene, settings);
    const Camera camera = first_camera(scene);
    const Frame first = renderer.render(camera, 0.0);
    settings = grouped(scene, settings, "a=right");
    renderer.change(settings);
    const Frame second = renderer.render(camera, 0.0);
    EXPECT_NE(layer_of(first, "a").values, layer_of(second, "a").values);
    EXPECT_EQ(layer_of(second, "a").values, layer_of(render_once(scene, settings), "a").values);
}

TEST(LightGroups, EachIsAGroupOfEachNode) {
    const Scene scene = named_grid();
    const auto groups = light_groups_of(scene, {}, parse_light_groups("--light-groups", "each"));
    ASSERT_EQ(groups.size(), 2u);
    EXPECT_EQ(groups[0].name, "left");
    EXPECT_EQ(groups[1].name, "right");
    LightOptions spheres;
    spheres.count = 9;
    spheres.size = 0.1;
    EXPECT_EQ(light_groups_of(Scene(), spheres, parse_light_groups("", "a=kind:sphere")).size(),
              1u);
    EXPECT_EQ(group_of(scene.lights[1], scene, groups), 2);
    EXPECT_EQ(group_of(scene.lights.back(), scene, groups), 0);
}

TEST(LightGroups, SayWhatIsWrong) {
    EXPECT_TRUE(parse_light_groups("--light-groups", "none").empty());
    const Scene scene = named_grid();
    struct Case {
        const char* groups;
        const char* reason;
    } cases[] = {{"key", "--light-groups: 'key' is not NAME=PATTERN"},
                 {"k y=a", "'k y' is no name of a group"},
                 {"rest=a", "'rest' is no name of a group"},
                 {"a=left,a=right", "two groups are named 'a'"},
                 {"a=colour:red", "a: 'colour:red' is no pattern; a pattern is GLOB (name of the"},
                 {"a=", "a: '' is no pattern"},
                 {"a=lamp", "no light is in 'a' (lamp)"},
                 {"a=left,b=l*", "no light is in 'b' (l*)"}};
    for (const Case& c : cases) {
        const std::string message =
            message_of<UsageError>([&] { grouped(scene, small_settings(96, 54, 0), c.groups); });
        EXPECT_TRUE(contains(message, c.reason)) << message;
    }
    RenderSettings settings = grouped(scene, small_settings());
    settings.renderer = RendererKind::forward;
    expect_refused(scene, settings, "light groups: the forward renderers have no layers");
}

}  // namespace
}  // namespace kilolux
