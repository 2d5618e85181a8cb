// SPDX-License-Identifier: Apache-2.0
// Which scenes --emissive-lights lights, and what it says.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "host/base/error.h"
#include "host/scene/gltf/load_scene.h"
#include "present/cli/option_builder.h"
#include "present/cli/scene_choice.h"
#include "tests/support/child.h"
#include "tests/support/lit_hall.h"
#include "tests/support/messages.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

class EmissiveLightsOption : public testing::Test {
 protected:
    EmissiveLightsOption() {
        Scene scene = glowing_box();
        write_scene(scene, folder_ / "glow.glb");
        scene.lights.resize(1);
        write_scene(scene, folder_ / "lamp.glb");
        scene.materials[0].emissive = {};
        scene.lights.clear();
        write_scene(scene, folder_ / "dark.glb");
    }

    static Scene glowing_box() {
        Scene scene = box_scene({2.0, 3.0, 4.0});
        scene.materials[0].emissive = {3.0f, 2.0f, 1.0f};
        return scene;
    }

    // The number of lights of surfaces, and of others.
    std::pair<std::ptrdiff_t, std::ptrdiff_t> lights(const std::string& file,
                                                     const std::string& more) {
        CLI::App app;
        options_ = {};
        add_options(app, options_);
        app.parse((folder_ / file).string() + " -q " + more);
        begin_command(options_);
        AnimatedScene scene = open_animated_scene(options_);
        line_ = light_scene(options_, scene);
        scene.replace_lights({});
        light_scene(options_, scene);  // a second time, as the window does: none are doubled
        const auto& all = scene.scene().lights;
        const auto of_surfaces = std::ranges::count(all, true, &SceneLight::of_surface);
        const auto others = static_cast<std::ptrdiff_t>(all.size()) - of_surfaces;
        scene_.emplace(std::move(scene).take());
        return {of_surfaces, others};
    }

    TemporaryFolder folder_;
    SharedOptions options_;
    std::optional<Scene> scene_;
    std::string line_;
};

using LightCounts = std::pair<std::ptrdiff_t, std::ptrdiff_t>;

TEST_F(EmissiveLightsOption, AutomaticIsOnWhereNothingElseLights) {
    EXPECT_EQ(lights("glow.glb", "--rig none"), LightCounts(6, 0));
    EXPECT_TRUE(contains(line_,
                         "\nglow    (automatic) 12 triangles of 1 glowing meshes are 6 "
                         "lights, 6 of them rectangles"))
        << line_;
    EXPECT_EQ(lights("glow.glb", "--lights 0"), LightCounts(6, 0));
    EXPECT_EQ(lights("glow.glb", "").first, 0) << "a studio";
    EXPECT_EQ(lights("glow.glb", "--lights 20").first, 0);
    EXPECT_EQ(lights("glow.glb", "--environment sky --environment-lights 2"), LightCounts(0, 2));
    EXPECT_EQ(lights("lamp.glb", ""), LightCounts(0, 1));
    EXPECT_EQ(lights("dark.glb", "--rig none"), LightCounts(0, 0));
    EXPECT_FALSE(contains(line_, "glow")) << line_;
}

TEST_F(EmissiveLightsOption, AutomaticIsOffWhereLightsWithASizeAreRefused) {
    for (const char* more : {"--shadows exact", "--shading blinn-phong"}) {
        EXPECT_EQ(lights("glow.glb", std::string("--rig none ") + more), LightCounts(0, 0)) << more;
    }
    EXPECT_EQ(lights("glow.glb", "--rig none --shadows sampled"), LightCounts(6, 0));
}

TEST_F(EmissiveLightsOption, OnAndOffAreMeantAsSaid) {
    EXPECT_EQ(lights("glow.glb", "--emissive-lights off --rig none"), LightCounts(0, 0));
    EXPECT_EQ(lights("lamp.glb", "--emissive-lights on"), LightCounts(6, 1));
    EXPECT_TRUE(contains(line_, "\nglow    12 triangles")) << line_;
    EXPECT_TRUE(contains(line_, "1 of the scene's own lights")) << line_;
    EXPECT_EQ(lights("glow.glb", "--emissive-lights on --rig studio"), LightCounts(6, 5));
    for (const char* more : {"--shadows exact", "--shading blinn-phong"}) {
        lights("glow.glb", std::string("--emissive-lights on --rig none ") + more);
        RenderSettings settings = small_settings(16, 16, 0);
        settings.shading = options_.settings.shading;
        settings.shadows = options_.settings.shadows;
        expect_refused(*scene_, settings, std::string(more).substr(2));
    }
}

// A tree holds points alone: thousands of triangles without a range would reach every pixel.
TEST_F(EmissiveLightsOption, ManyTakeNoTree) {
    Scene scene = lit_hall(0, 1.0f);
    scene.materials.push_back(scene.materials[0]);
    scene.materials.back().emissive = glm::vec3(3.0f);
    scene.meshes.push_back(box_mesh(glm::dvec3(1.0)));
    scene.meshes.back().material = 1;
    for (int i = 0; i < 60; ++i) {
        glm::dmat4 place(1.0);
        place[3] = {0.0, 2.0, -190.0 + 6.0 * i, 1.0};
        scene.instances.push_back({1, place});
    }
    write_scene(scene, folder_ / "many.glb");
    EXPECT_EQ(lights("many.glb", "--rig none"), LightCounts(360, 0));
    EXPECT_NE(options_.settings.tails, Tails::tree);
    EXPECT_TRUE(contains(line_, "360 lights without a range end where")) << line_;
}

// The file has the mesh: its lights are made again.
TEST_F(EmissiveLightsOption, AreNotExported) {
    const std::string out = (folder_ / "out.glb").string();
    const ChildResult run = run_kilolux(
        {"export", (folder_ / "lamp.glb").string(), "-o", out, "--emissive-lights", "on"});
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_TRUE(contains(run.err, "lights  1 written, 0 unusable left out")) << run.err;
    EXPECT_EQ(load_scene(out).lights.size(), 1u);
}

// Nor are their gains, unlike those of other lights.
TEST_F(EmissiveLightsOption, AreNotExportedWithTheirGains) {
    const auto run = [&](const char* mix) {
        return run_kilolux({"export", (folder_ / "lamp.glb").string(), "-o",
                            (folder_ / "out.glb").string(), "--emissive-lights", "on",
                            "--light-groups", "glow=from:surfaces,lamp=from:file", "--light-mix",
                            mix});
    };
    const std::string warning = "the light mix changes ";
    const ChildResult dimmed = run("lamp=0.5,glow=0.5");
    EXPECT_EQ(dimmed.code, 0) << dimmed.err;
    EXPECT_TRUE(contains(dimmed.err, warning)) << dimmed.err;
    EXPECT_FALSE(contains(run("lamp=0.25").err, warning));
    const Scene out = load_scene(folder_ / "out.glb");
    const Scene lamp = load_scene(folder_ / "lamp.glb");
    ASSERT_EQ(out.lights.size(), 1u);
    EXPECT_NEAR(out.lights[0].intensity.x, 0.25f * lamp.lights[0].intensity.x, 1e-5);
}

TEST_F(EmissiveLightsOption, AreCountedByInfo) {
    const ChildResult run = run_kilolux({"info", (folder_ / "glow.glb").string(), "--rig", "none"});
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_TRUE(contains(run.out, "of_surfaces: 6")) << run.out;
}

}  // namespace
}  // namespace kilolux
