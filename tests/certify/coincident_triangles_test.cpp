// SPDX-License-Identifier: Apache-2.0
// Of triangles at one depth the first is shown, on every way of drawing.
#include <gtest/gtest.h>

#include <algorithm>

#include "host/scene/camera.h"
#include "tests/certify/triangle_drawing.h"
#include "tests/support/quad_scene.h"

namespace kilolux {
namespace {

// A floor of two triangles, and the same two once more. With `mask`, alpha is tested.
Scene floors(bool mask) {
    Scene scene = quad_scene(8.0f);
    Mesh& mesh = scene.meshes.front();
    const std::vector<std::uint32_t> once = mesh.indices;
    mesh.indices.insert(mesh.indices.end(), once.begin(), once.end());
    if (mask) {
        scene.materials.front().alpha_mode = AlphaMode::mask;
        scene.materials.front().alpha_cutoff = 0.5f;
    }
    return scene;
}

void expect_first(const std::vector<Shown>& drawn, const std::string& what) {
    EXPECT_GT(std::ranges::count_if(drawn, [](const Shown& s) { return s != Shown{}; }), 300)
        << what;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        ASSERT_TRUE(drawn[i] == Shown{} || drawn[i].triangle < 2) << what << ", pixel " << i;
    }
}

TEST(CoincidentTriangles, TheFirstIsShown) {
    // Before the camera, and below it, where the near plane cuts them.
    const Camera whole = look_at({1, -2, 20}, {0, 0, 0}, {0, 1, 0}, 0.9);
    const Camera cut = look_at({0.3, -6, 0.5}, {0, 3, 0}, {0, 0, 1}, 1.2);
    for (const bool mask : {false, true}) {
        const Scene scene = floors(mask);
        for (const auto& [lanes, group] : {std::pair{1, 1}, {16, 1}, {1, 64}}) {
            Tuning tuning = default_tuning(test_gpu().info);
            tuning.raster_tile_width = tuning.raster_tile_height = 32;
            tuning.raster_group = group;
            tuning.raster_lanes = lanes;
            Drawing drawing(scene, test_gpu(lanes), tuning);
            const std::string what = std::to_string(lanes) + " lanes, groups of " +
                                     std::to_string(group) + (mask ? ", masked" : "");
            expect_first(drawing.at(whole, 61, 37), what);
            expect_first(drawing.at(cut, 61, 37), what + ", cut");
        }
    }
}

}  // namespace
}  // namespace kilolux
