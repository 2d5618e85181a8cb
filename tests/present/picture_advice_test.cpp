// SPDX-License-Identifier: Apache-2.0
// A picture that shows nothing says why.
#include "present/commands/picture_advice.h"

#include <gtest/gtest.h>

#include "host/render/renderer.h"
#include "host/scene/framing.h"
#include "host/scene/lights/rig.h"
#include "tests/support/box_scene.h"
#include "tests/support/messages.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

std::string advice(const Scene& scene, const Camera& camera,
                   RendererKind renderer = RendererKind::deferred) {
    RenderSettings settings = small_settings(48, 32, 0);
    settings.renderer = renderer;
    const Frame frame = Renderer(scene, settings).render(camera, 0.0);
    return picture_advice(scene, camera, settings, frame.stats);
}

Scene lit_box(Rig rig = Rig::studio, bool inwards = false) {
    Scene scene = box_scene(glm::dvec3(2.0), inwards);
    scene.lights = rig_lights(rig);
    return scene;
}

Camera from(const glm::dvec3& position, const glm::dvec3& focal) {
    return look_at(position, focal, {0, 1, 0}, 0.8);
}

TEST(PictureAdvice, SaysNothingOfAPictureThatShowsSomething) {
    for (const Rig rig : {Rig::studio, Rig::headlight}) {
        const Scene scene = lit_box(rig);
        EXPECT_EQ(advice(scene, framing_camera(scene, 1.5)), "");
    }
}

TEST(PictureAdvice, NoLights) {
    Scene scene = lit_box(Rig::none);
    const Camera camera = framing_camera(scene, 1.5);
    EXPECT_EQ(advice(scene, camera),
              "picture has no lights, only ambient and emitted light; try --rig studio");
    scene.lights.emplace_back();
    scene.lights[0].intensity = glm::vec3(0.0f);
    EXPECT_TRUE(contains(advice(scene, camera), "no usable lights, all 1 were rejected"));
}

TEST(PictureAdvice, ShadowsOfLightsThatCastNone) {
    Scene scene = lit_box();
    RenderSettings settings;
    settings.shadows = Shadows::exact;
    FrameStats stats;
    stats.active_clusters = 1;
    stats.lights_given = stats.lights_used = stats.directional_lights = 5;
    const Camera camera = framing_camera(scene, 1.5);
    EXPECT_TRUE(contains(picture_advice(scene, camera, settings, stats), "no shadows"));
    stats.directional_lights = 4;
    stats.refined_pairs = 1;
    EXPECT_EQ(picture_advice(scene, camera, settings, stats), "");
}

TEST(PictureAdvice, LightsOutOfReach) {
    Scene scene = lit_box(Rig::none);
    SceneLight light;
    light.position = {0.0, 0.0, 50.0};
    light.range = 3.0f;
    scene.lights.push_back(light);
    const Camera camera = framing_camera(scene, 1.5);
    EXPECT_TRUE(contains(advice(scene, camera), "none of 1 lights reaches a surface"));
    scene.lights[0].position = {0.0, 0.0, 2.0};
    EXPECT_EQ(advice(scene, camera), "");
}

TEST(PictureAdvice, NoSurface) {
    const Scene scene = lit_box();
    for (const RendererKind renderer : {RendererKind::deferred, RendererKind::forward}) {
        EXPECT_TRUE(contains(advice(scene, from({0, 0, 9}, {0, 0, 20}), renderer),
                             "picture is empty: the scene is behind the camera"));
        EXPECT_TRUE(contains(advice(scene, from({0, 0, 9}, {20, 0, 8}), renderer),
                             "picture is empty: the scene is beside the camera's view"));
        Camera clipped = from({0, 0, 9}, {0, 0, 0});
        clipped.z_far = 2.0;
        EXPECT_TRUE(contains(advice(scene, clipped, renderer), "beyond the camera's far plane"));
        clipped.z_near = 50.0;
        clipped.z_far = 90.0;
        EXPECT_TRUE(contains(advice(scene, clipped, renderer), "nearer than the camera's near"));
    }
    Scene turned = lit_box(Rig::studio, true);
    turned.meshes[0].indices.resize(6);  // one wall, which faces +X
    EXPECT_TRUE(contains(advice(turned, from({-9, 0, 0}, {0, 0, 0})),
                         "picture is empty: all faces are turned away from the camera"));
    Scene cut = lit_box();
    cut.materials[0].alpha_mode = AlphaMode::mask;
    cut.materials[0].base_color.w = 0.1f;
    EXPECT_TRUE(contains(advice(cut, framing_camera(cut, 1.5)), "cut by alpha"));
    EXPECT_TRUE(contains(advice(Scene{}, from({0, 0, 9}, {0, 0, 0})), "has no triangles"));
}

// The automatic camera is no advice where it is the picture's, nor is a view that is in force.
TEST(PictureAdvice, NamesNothingThatIsInForce) {
    Scene scene = lit_box();
    const RenderSettings settings = small_settings(48, 32, 0);
    FrameStats stats;
    stats.lights_given = stats.lights_used = stats.directional_lights = 5;
    const auto said = [&](const Camera& camera, bool framed) {
        return picture_advice(scene, camera, settings, stats, framed);
    };
    const std::string behind = "picture is empty: the scene is behind the camera; ";
    EXPECT_EQ(said(from({0, 0, 9}, {0, 0, 20}), false), behind + "try --camera-index auto");
    EXPECT_EQ(said(from({0, 0, 9}, {0, 0, 20}), true),
              behind + "the automatic camera frames it as it is at --time");
    scene = lit_box(Rig::studio, true);
    scene.meshes[0].indices.resize(6);  // one wall, which faces +X
    const std::string away = "picture is empty: all faces are turned away from the camera; try ";
    EXPECT_EQ(said(from({-9, 0, 0}, {0, 0, 0}), false), away + "--camera-index auto");
    scene.kind = SceneKind::closed;
    EXPECT_EQ(said(from({-9, 0, 0}, {0, 0, 0}), true), away + "--view inside");
    scene.kind = SceneKind::interior;
    EXPECT_EQ(said(from({-9, 0, 0}, {0, 0, 0}), true), away + "--view outside");
}

}  // namespace
}  // namespace kilolux
