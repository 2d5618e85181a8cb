// SPDX-License-Identifier: Apache-2.0
#include "raster/solid_pass.h"

#include "tests/raster/gl_fixture.h"

namespace kilolux {
namespace {

using OverdrawPassTest = GlTest;

float count_at_center(const Scene& scene, double camera_z) {
    const GpuScene gpu(scene);
    OverdrawPass pass(gpu);
    return pass.count(front_camera(camera_z), 9, 7)[3 * 9 + 4];
}

TEST_F(OverdrawPassTest, CountsWhatIsShadedInFrontToBackOrder) {
    Scene scene = one_object(quad_mesh());
    for (const double z : {-1.0, -2.0}) scene.instances.push_back({0, translation({0, 0, z})});
    EXPECT_EQ(count_at_center(scene, 2), 1.0f) << "sorted: the nearest hides the others";
    // One object with its layers from back to front cannot be sorted.
    Scene layered = one_object(quad_mesh());
    Mesh& mesh = layered.meshes[0];
    for (std::uint32_t layer = 1; layer <= 2; ++layer) {
        for (std::size_t v = 0; v < 4; ++v) {
            mesh.positions.push_back(mesh.positions[v] +
                                     glm::vec3(0, 0, 0.25f * static_cast<float>(layer)));
            mesh.normals.push_back(mesh.normals[v]);
        }
        for (std::size_t i = 0; i < 6; ++i) mesh.indices.push_back(mesh.indices[i] + 4 * layer);
    }
    mesh.tangents.clear();
    mesh.texcoords[0].clear();
    EXPECT_EQ(count_at_center(layered, 2), 3.0f);
}

TEST_F(OverdrawPassTest, MaskedFragmentsDoNotCount) {
    Scene scene = one_object(quad_mesh());
    scene.materials[0].alpha_mode = AlphaMode::mask;
    scene.materials[0].base_color.w = 0.25f;
    EXPECT_EQ(count_at_center(scene, 2), 0.0f);
    scene.materials[0].base_color.w = 0.75f;
    EXPECT_EQ(count_at_center(scene, 2), 1.0f);
}

}  // namespace
}  // namespace kilolux
