// SPDX-License-Identifier: Apache-2.0
// KHR_materials_clearcoat on a sphere of car paint: every renderer against float64 rays.
#include <gtest/gtest.h>

#include "tests/support/lobe_pictures.h"

namespace kilolux {
namespace {

Scene lit_car_paint() { return with_ring_of_lights(car_paint_scene()); }

TEST(Clearcoat, EveryRendererShowsTheFloat64Reference) {
    expect_reference_in_every_renderer(lit_car_paint());
}

TEST(Clearcoat, ListsAndAllLightsAreTheSameBits) {
    expect_lists_and_all_lights_same(lit_car_paint());
}

TEST(Clearcoat, AFactorOfZeroIsTheMaterialWithoutIt) {
    Scene scene = lit_car_paint(), plain = scene;
    scene.materials[0].clearcoat_texture = add_texel(scene, {0, 0, 0, 255});
    plain.materials[0].clearcoat = 0.0f;
    expect_same_without(scene, plain, &SceneFeatures::clearcoat);
}

}  // namespace
}  // namespace kilolux
