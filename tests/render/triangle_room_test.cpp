// SPDX-License-Identifier: Apache-2.0
// Lists of triangles that outgrow their room: the frame is drawn again, complete.
#include <gtest/gtest.h>

#include "host/gpu/tuning/tuning_store.h"
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

// Squares whose pairs with the tiles of this device's tuning are more than `pairs`: a square of the
// pile makes at least one with each tile.
int squares_for(std::uint64_t pairs, const RenderSettings& settings) {
    const Tuning tuning = known_tuning(settings.opened->info).tuning;
    const int columns = (settings.width + tuning.raster_tile_width - 1) / tuning.raster_tile_width;
    const int rows = (settings.height + tuning.raster_tile_height - 1) / tuning.raster_tile_height;
    return static_cast<int>(pairs) / (columns * rows) + 100;
}

TEST(TriangleRoom, AFrameThatOutgrowsItIsWhole) {
    constexpr std::uint64_t kFirstRoom = std::uint64_t{1} << 18;
    const Scene scene = pile_of_squares(
        squares_for(kFirstRoom, settings_of(RendererKind::deferred, Geometry::compute)));
    const Camera camera = camera_before_the_pile();
    for (const RendererKind kind : {RendererKind::deferred, RendererKind::deferred_all}) {
        Renderer renderer(scene, settings_of(kind, Geometry::compute));
        const Frame first = renderer.render(camera, 0.0);
        const Frame second = renderer.render(camera, 0.1);
        const Frame third = renderer.render(camera, 0.0);
        EXPECT_GT(first.stats.triangle_pairs, kFirstRoom) << "they fit from the start";
        EXPECT_EQ(first.display, third.display);
        EXPECT_NE(first.display, second.display);
        Renderer by_opengl(scene, settings_of(kind, Geometry::ids));
        EXPECT_EQ(first.display, by_opengl.render(camera, 0.0).display);
    }
}

// The frame's loop repeats forward-plus where its coarse lists had no room.
TEST(ListRoom, AForwardPlusFrameThatOutgrowsItIsWhole) {
    constexpr std::uint64_t kFirstRoom = std::uint64_t{1} << 20;
    const Scene scene = make_generated_scene("grid");
    RenderSettings settings = small_settings(64, 36, 6000);
    settings.renderer = RendererKind::forward_plus;
    settings.lights.radius = 100.0f;
    Renderer renderer(scene, settings);
    const Frame first = renderer.render(first_camera(scene), 0.0);
    renderer.render(first_camera(scene), 0.1);
    EXPECT_GT(first.stats.coarse_pairs, kFirstRoom) << "they fit from the start";
    EXPECT_EQ(first.radiance, renderer.render(first_camera(scene), 0.0).radiance);
}

}  // namespace
}  // namespace kilolux
