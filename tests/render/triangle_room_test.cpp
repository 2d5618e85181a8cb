// SPDX-License-Identifier: Apache-2.0
// Lists of triangles that outgrow their room: the frame is drawn again, whole.
#include <gtest/gtest.h>

#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

// A pile of squares that fill the view, each behind the one before; far more pairs of triangle and
// tile than there is room for at first.
Scene pile_of_squares(int count) {
    Scene scene;
    scene.name = "pile";
    Mesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.indices = {0, 1, 2, 0, 2, 3};
    scene.meshes = {mesh};
    for (int i = 0; i < count; ++i) {
        glm::dmat4 place(1.0);
        place[0][0] = place[1][1] = 2.0;
        place[3].z = -0.001 * i;
        scene.instances.push_back({0, place});
    }
    return scene;
}

Camera camera_before_the_pile() {
    Camera camera;
    camera.position = {0.0, 0.0, 1.0};
    camera.z_near = 0.01;
    return camera;
}

RenderSettings settings_of(RendererKind renderer, Geometry geometry) {
    RenderSettings settings = small_settings(640, 360, 20);
    settings.renderer = renderer;
    settings.geometry = geometry;
    return settings;
}

TEST(TriangleRoom, AFrameThatOutgrowsItIsWhole) {
    const Scene scene = pile_of_squares(1200);
    const Camera camera = camera_before_the_pile();
    for (const RendererKind kind : {RendererKind::deferred, RendererKind::deferred_all}) {
        Renderer renderer(scene, settings_of(kind, Geometry::compute));
        const Frame first = renderer.render(camera, 0.0);
        const Frame second = renderer.render(camera, 0.1);
        const Frame third = renderer.render(camera, 0.0);
        EXPECT_GT(first.stats.triangle_pairs, std::uint64_t{1} << 18) << "they fit from the start";
        EXPECT_EQ(first.display, third.display);
        EXPECT_NE(first.display, second.display);
        Renderer by_opengl(scene, settings_of(kind, Geometry::ids));
        EXPECT_EQ(first.display, by_opengl.render(camera, 0.0).display);
    }
}

}  // namespace
}  // namespace kilolux
