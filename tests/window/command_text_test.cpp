// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/command_text.h"
#include "present/cli/option_builder.h"

#include <gtest/gtest.h>

#include <CLI/App.hpp>
#include <sstream>

#include "host/scene/generated/scenes.h"

namespace kilolux {
namespace {

// The options that `kilolux render` would parse.
SharedOptions parsed(const std::string& command) {
    std::istringstream in(command);
    std::vector<std::string> words;
    for (std::string word; in >> word;) words.push_back(word);
    words.erase(words.begin(), words.begin() + 2);  // kilolux render
    words.resize(words.size() - 2);                 // -o kilolux.png
    SharedOptions options;
    CLI::App app;
    add_options(app, options);
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
    return options;
}

TEST(CommandText, DefaultsNeedNoOptions) {
    const Scene scene = make_generated_scene("plain");
    SharedOptions options;
    options.scene = "plain";
    const CameraRig rig(choose_camera(options.camera, scene), bounds(scene));
    EXPECT_EQ(render_command(rig, options, scene), "kilolux render plain -o kilolux.png");
}

// A rig has other defaults than the command line without one.
TEST(CommandText, SaysTheLightsOfARig) {
    const Scene scene = make_generated_scene("plain");
    SharedOptions options;
    options.scene = "plain";
    const CameraRig rig(choose_camera(options.camera, scene), bounds(scene));
    options.rig = Rig::studio;
    const std::string command = render_command(rig, options, scene);
    const SharedOptions again = parsed(command);
    EXPECT_EQ(again.rig, Rig::studio) << command;
    EXPECT_TRUE(again.lights_given && again.ambient_given) << command;
    EXPECT_EQ(again.settings, options.settings) << command;
}

// Groups without a gain would ask for layers, which a PNG has not.
TEST(CommandText, SaysGroupsOfLightsWithTheirGains) {
    const Scene scene = make_generated_scene("plain");
    SharedOptions options;
    options.scene = "plain";
    options.light_groups = parse_light_groups("", "all=*");
    const CameraRig rig(choose_camera(options.camera, scene), bounds(scene));
    EXPECT_EQ(render_command(rig, options, scene), "kilolux render plain -o kilolux.png");
    options.settings.light_mix.gains = {{"all", 0.5f, {1.0f, 0.5f, 0.25f}}};
    EXPECT_EQ(render_command(rig, options, scene),
              "kilolux render plain --light-groups 'all=*' --light-mix all=0.5:1,0.5,0.25 "
              "-o kilolux.png");
}

TEST(CommandText, ReproducesEverySetting) {
    const Scene scene = make_generated_scene("plain");
    SharedOptions options;
    options.scene = "plain";
    options.time = 1.0 / 3.0;
    RenderSettings& s = options.settings;
    s.renderer = RendererKind::forward_plus;
    s.width = 333;
    s.height = 222;
    s.lights.count = 4321;
    s.lights.seed = 7;
    s.lights.radius = 0.1;
    s.lights.intensity = 2.0 / 3.0;
    s.lights.size = 0.07;
    s.gbuffer = GBUFFER_FULL;
    s.shading = Shading::blinn_phong;
    s.ambient = 0.3f;
    s.bloom = 0.07f;
    s.exposure = -1.1f;
    s.tone_curve = ToneCurve::aces;
    s.samples = 3;
    s.want.view = ViewKind::slices;
    s.grid = {20, 11, 8, 16};
    s.kernels.lanes = 4;
    CameraRig rig(choose_camera(options.camera, scene), bounds(scene));
    rig.move({.move = {0.5, -0.2, -1.0}, .look = {0.3, -0.1}}, CameraMode::fly, 0.37);
    const std::string command = render_command(rig, options, scene);
    const SharedOptions again = parsed(command);
    EXPECT_EQ(again.settings, options.settings) << command;
    EXPECT_EQ(again.time, options.time) << command;
    const Camera camera = choose_camera(again.camera, scene);
    EXPECT_EQ(camera.position, rig.camera().position) << command;
    EXPECT_EQ(camera.world_from_view, rig.camera().world_from_view) << command;
    EXPECT_EQ(camera.z_near, rig.camera().z_near) << command;
}

}  // namespace
}  // namespace kilolux
