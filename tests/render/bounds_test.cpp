// SPDX-License-Identifier: Apache-2.0
// The box of a scene's vertices is found at few places of a load and at none of a frame that moves
// no surface.
#include <atomic>

#include "host/scene/animated_scene.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/render_fixture.h"

namespace kilolux {

// The linker gives calls of bounds() to the second and those of the first to bounds()
// (tests/CMakeLists.txt).
Box real_bounds(const Scene& scene) asm("__real__ZN7kilolux6boundsERKNS_5SceneE");
Box counted_bounds(const Scene& scene) asm("__wrap__ZN7kilolux6boundsERKNS_5SceneE");

static std::atomic<int> boxes_found = 0;

Box counted_bounds(const Scene& scene) {
    ++boxes_found;
    return real_bounds(scene);
}

namespace {

// A triangle, and a node that a clip moves: with a camera alone, or the triangle's own.
GltfBuilder file_with_moving_node(bool camera_alone) {
    GltfBuilder file = triangle_file();
    file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}});
    const int camera = file.add_node({{"camera", 0}, {"translation", {0, 0, 3}}});
    const int node = camera_alone ? camera : 0;
    const int times = file.add_floats("SCALAR", {0, 1});
    const int path = file.add_floats("VEC3", {0, 0, 3, 0, 0, 4});
    file.add(
        "animations",
        {{"samplers", {{{"input", times}, {"output", path}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", "translation"}}}}}}});
    return file;
}

int boxes_found_by(const std::function<void()>& work) {
    boxes_found = 0;
    work();
    return boxes_found;
}

TEST(Bounds, AreFoundByTheLoadTheRendererAndTheShadowsOnceEach) {
    const TempFolder folder;
    const auto path = folder.path() / "scene.glb";
    for (const bool camera_alone : {true, false}) {
        write_file(path, file_with_moving_node(camera_alone).glb());
        std::optional<AnimatedScene> moving;
        EXPECT_EQ(boxes_found_by([&] { moving.emplace(path, LoadOptions{}); }), 1);
        RenderSettings settings = small_settings(32, 18, 5);
        std::optional<Renderer> renderer;
        const auto frame = [&](double time) {
            moving->set_time(time);
            renderer->render(camera_of(moving->scene().cameras.front()), time);
        };
        EXPECT_EQ(boxes_found_by([&] {
                      renderer.emplace(moving->scene(), settings);
                      frame(0.0);
                  }),
                  1);
        const int of_a_frame = boxes_found_by([&] { frame(0.5); });
        EXPECT_EQ(of_a_frame, camera_alone ? 0 : 1);
        settings.shadows = Shadows::exact;
        EXPECT_EQ(boxes_found_by([&] {
                      renderer.emplace(moving->scene(), settings);
                      frame(0.5);
                  }),
                  2);
    }
}

}  // namespace
}  // namespace kilolux
