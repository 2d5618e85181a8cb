// SPDX-License-Identifier: Apache-2.0
// KHR_materials_clearcoat on a sphere of car paint: every renderer against float64 rays.
#include <gtest/gtest.h>

#include "tests/support/lobe_pictures.h"

namespace kilolux {
namespace {

Scene lit_car_paint() { return with_ring_of_lights(car_paint_scene()); }

// Paint and coat are as smooth as the sphere.
Scene lit_smooth_paint() {
    Scene scene = lit_car_paint();
    scene.materials[0].normal_texture = scene.materials[0].clearcoat_normal_texture = {};
    return scene;
}

TEST(Clearcoat, EveryRendererShowsTheFloat64Reference) {
    for (const Scene& scene : {lit_car_paint(), lit_smooth_paint()})
        expect_reference_in_every_renderer(scene);
}

TEST(Clearcoat, HasNormalsOfItsOwnOnlyWhereACoatedMaterialHasANormalMap) {
    const auto has_them = [](const Scene& scene) {
        return make_scene_plan(scene, lobe_settings(), 12).gbuffer.coat_normals;
    };
    Scene scene = lit_smooth_paint();
    EXPECT_FALSE(has_them(scene));
    for (TextureUse Material::*map :
         {&Material::normal_texture, &Material::clearcoat_normal_texture}) {
        Scene mapped = scene;
        mapped.materials[0].*map = lit_car_paint().materials[0].clearcoat_texture;
        EXPECT_TRUE(has_them(mapped));
        mapped.materials[0].clearcoat = 0.0f;
        EXPECT_FALSE(has_them(mapped));
    }
}

TEST(Clearcoat, ASurfacesOwnNormalsAreTheSameBitsWithAndWithoutTheirPlane) {
    for (const uint layout : {uint{GBUFFER_PACKED}, uint{GBUFFER_FULL}}) {
        RenderSettings settings = lobe_settings(layout);
        const Scene scene = lit_smooth_paint();
        const std::vector<float> without =
            Renderer(scene, settings).render(sphere_camera(), 0.0).radiance;
        settings.force_features = {"coat-normals"};
        Renderer with(scene, settings);
        EXPECT_TRUE(with.plan().kernels.coat_normals);
        EXPECT_EQ(with.render(sphere_camera(), 0.0).radiance, without);
    }
}

TEST(Clearcoat, ListsAndAllLightsAreTheSameBits) {
    for (const Scene& scene : {lit_car_paint(), lit_smooth_paint()})
        expect_lists_and_all_lights_same(scene);
}

TEST(Clearcoat, AFactorOfZeroIsTheMaterialWithoutIt) {
    Scene scene = lit_car_paint(), plain = scene;
    scene.materials[0].clearcoat_texture = add_texel(scene, {0, 0, 0, 255});
    plain.materials[0].clearcoat = 0.0f;
    expect_same_without(scene, plain, &SceneFeatures::clearcoat);
}

}  // namespace
}  // namespace kilolux
