// SPDX-License-Identifier: Apache-2.0
// Materials that blend: drawn last, back to front, over a forward or another renderer's picture.
#include <algorithm>

#include "raster/forward_pass.h"
#include "tests/raster/gl_fixture.h"

namespace kilolux {
namespace {

using BlendTest = GlTest;

constexpr int kWidth = 75;
constexpr int kHeight = 41;
constexpr uint kStride = 80;

Camera panes_camera() { return front_camera(6); }

std::vector<float> draw(const Scene& scene) {
    const GpuScene gpu(scene);
    ForwardPass pass(gpu, {});
    pass.draw(panes_camera(), kWidth, kHeight, {});
    return pass.read_radiance(kStride);
}

// Two panes over a wall, given in the wrong order; colours are what they emit.
Scene panes_scene() {
    Scene scene = one_object(quad_mesh(100.0f));
    for (const glm::vec4 color : {glm::vec4(1, 0, 0, 0.5f), {0, 1, 0, 0.25f}}) {
        Material material;
        material.unlit = true;
        material.alpha_mode = AlphaMode::blend;
        material.base_color = color;
        scene.materials.push_back(material);
        scene.meshes.push_back(quad_mesh(100.0f));
        scene.meshes.back().material = static_cast<int>(scene.materials.size()) - 1;
    }
    scene.materials[0].unlit = true;
    scene.materials[0].base_color = {0, 0, 2, 1};
    scene.instances.push_back({1, translation({0, 0, 2})});
    scene.instances.push_back({2, translation({0, 0, 1})});
    scene.instances.push_back({1, translation({0, 0, -1})});  // behind the wall
    return scene;
}

TEST_F(BlendTest, BlendsBackToFront) {
    const Scene scene = panes_scene();
    EXPECT_TRUE(has_blended_surfaces(scene));
    EXPECT_FALSE(has_blended_surfaces(one_object(quad_mesh())));
    const std::vector<float> radiance = draw(scene);
    const std::size_t plane = std::size_t{kStride} * kHeight;
    EXPECT_FLOAT_EQ(radiance[0], 0.5f);
    EXPECT_FLOAT_EQ(radiance[plane], 0.125f);
    EXPECT_FLOAT_EQ(radiance[2 * plane], 2.0f * 0.75f * 0.5f);
}

TEST_F(BlendTest, BlendedDoubleSidedShowsBothFaces) {
    Scene scene = panes_scene();
    scene.instances = {scene.instances[0], scene.instances[1]};
    const glm::dmat4 turned(glm::dmat3(-1, 0, 0, 0, 1, 0, 0, 0, -1));
    scene.instances[1].world_from_object = translation({0, 0, 1}) * turned;
    EXPECT_EQ(draw(scene)[0], 0.0f) << "culled from behind";
    scene.materials[1].double_sided = true;
    EXPECT_FLOAT_EQ(draw(scene)[0], 0.5f);
}

}  // namespace
}  // namespace kilolux
