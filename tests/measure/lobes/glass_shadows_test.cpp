// SPDX-License-Identifier: Apache-2.0
// Shadows of KHR_materials_transmission and KHR_materials_volume against float64.
#include "tests/support/glass_pictures.h"

namespace kilolux {
namespace {

TEST(Glass, CastsTintedShadowsOrNone) {
    const Scene scene = glass_scene();
    for (const bool opaque : {false, true}) {
        RenderSettings settings = lobe_settings();
        settings.shadows = Shadows::exact;
        settings.opaque_shadows = opaque;
        const std::vector<double> found = glass_differences(scene, settings);
        EXPECT_LT(quantile(found, 0.5), 2e-5) << opaque;
        EXPECT_LT(quantile(found, 0.98), 5e-4) << opaque;
    }
}

// Maps of the second set of coordinates, and colours of vertices.
TEST(Glass, ShadowsAreTintedByEveryAttribute) {
    Scene scene = glass_scene();
    for (const std::size_t pane : {1u, 2u}) {
        Mesh& mesh = scene.meshes[pane];
        mesh.texcoords[1] = {{0.2f, 0.9f}, {0.8f, 1}, {0.7f, 0.1f}, {0.1f, 0}};
        mesh.colors = {{1, 0.5f, 1, 1}, {1, 1, 0.3f, 1}, {0.4f, 1, 1, 1}, {1, 1, 1, 1}};
        scene.materials[pane].transmission_texture = add_noise(scene, 4, 20, {64, 0, 0});
        scene.materials[pane].transmission_texture.uv_set = 1;
        scene.materials[pane].base_color_texture = add_noise(scene, 4, 21, {64, 64, 64});
    }
    RenderSettings settings = lobe_settings();
    settings.shadows = Shadows::exact;
    const std::vector<double> found = glass_differences(scene, settings);
    EXPECT_LT(quantile(found, 0.5), 3e-5);
    EXPECT_LT(quantile(found, 0.95), 2e-3);
}

// A lamp before panes that darken a wall: colour^panes, in any order of the panes.
TEST(Glass, SharesOfShadowsMultiply) {
    Material wall;
    wall.metallic = 0.0f;
    wall.roughness = 1.0f;
    Material red = glass({0.9f, 0.4f, 0.2f}), grey = glass(glm::vec3(0.5f));
    for (Material* m : {&red, &grey}) m->ior = 1.0f;
    grey.transmission = 0.0f;
    grey.alpha_mode = AlphaMode::blend;
    grey.base_color.w = 0.25f;
    const auto picture_of = [&](const std::vector<Material>& panes, int lanes) {
        Scene scene;
        add_glass_pane(scene, wall, -1.0, 0.0);
        double z = 0.0;
        for (const Material& pane : panes) add_glass_pane(scene, pane, z += 0.1, 0.0);
        SceneLight lamp;
        lamp.position = {0.0, 0.0, 3.0};
        lamp.intensity = glm::vec3(9.0f);
        lamp.range = 20.0f;
        scene.lights.push_back(lamp);
        RenderSettings settings = small_settings(17, 17, 0);
        settings.gbuffer = GBUFFER_FULL;
        settings.shading = Shading::lambert;
        settings.ambient = 0.0f;
        settings.shadows = Shadows::exact;
        settings.kernels.lanes = lanes;
        // From between the panes and the wall.
        return Renderer(scene, settings)
            .render(look_at({0, 0, -0.2}, {0, 0, -1}, {0, 1, 0}, 0.5), 0.0)
            .radiance;
    };
    const std::vector<float> bare = picture_of({}, 1);
    const std::vector<float> tinted = picture_of({red, grey, red}, 1);
    for (std::size_t i = 0; i < bare.size(); ++i) {
        const double red_share = red.base_color[static_cast<int>(i % 3)];
        ASSERT_NEAR(tinted[i], bare[i] * red_share * red_share * 0.75, 3e-6 * bare[i]) << i;
    }
    EXPECT_EQ(picture_of({grey, red, red}, 1), tinted);
    EXPECT_EQ(picture_of({red, red, grey}, 4), tinted);
}

TEST(Glass, ListsAndAllLightsAreTheSameBits) {
    expect_lists_and_all_lights_same(glass_scene(), kGlassCamera);
}

}  // namespace
}  // namespace kilolux
