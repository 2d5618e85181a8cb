// SPDX-License-Identifier: Apache-2.0
// A renderer shows what moved in its scene: the picture is that of a renderer made for it.
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

TEST(Animation, ARendererFollowsItsScene) {
    for (const RendererKind kind : {RendererKind::deferred, RendererKind::forward_plus}) {
        Scene scene = grid_with_every_light();
        RenderSettings settings = small_settings(80, 45, 50);
        settings.renderer = kind;
        const Camera camera = first_camera(scene);
        Renderer renderer(scene, settings);
        const Frame before = renderer.render(camera, 0.0);

        scene.instances.front().world_from_object[3].x += 1.5;
        for (SceneLight& light : scene.lights) light.position.y -= 0.5;
        Mesh& mesh = scene.meshes.back();
        for (glm::vec3& position : mesh.positions) position *= 1.5f;
        ++mesh.revision;
        scene.revisions = {1, 1, 1, 0};
        scene.light_box = resting_bounds(scene);
        const Frame moved = renderer.render(camera, 0.0);
        EXPECT_NE(moved.radiance, before.radiance);
        Renderer fresh(scene, settings);
        EXPECT_EQ(moved.radiance, fresh.render(camera, 0.0).radiance);
    }
}

}  // namespace
}  // namespace kilolux
