// SPDX-License-Identifier: Apache-2.0
// The atrium by lanterns: which lights hang there, and that their own meshes do not hide them.
#include <gtest/gtest.h>

#include <map>

#include "host/scene/lights/light_kinds.h"
#include "host/scene/lights/light_shape.h"
#include "host/scene/lights/rig.h"
#include "tests/scene/generated_scenes_fixture.h"

namespace kilolux {
namespace {

TEST(Lanterns, AreLightsOfThreeKindsWithASizeAndARange) {
    std::map<LightType, int> counts;
    for (const SceneLight& light : scene_of("lanterns").lights) {
        ++counts[light.type];
        EXPECT_TRUE(has_good_numbers(light)) << size_problem(light);
        EXPECT_GT(light.range, 5.0 * bounding_radius(light));
        for (int c = 0; c < 3; ++c) EXPECT_GT(light.intensity[c], 0.0f);
    }
    EXPECT_EQ(counts,
              (std::map<LightType, int>{
                  {LightType::rectangle, 24}, {LightType::disk, 20}, {LightType::sphere, 219}}));
}

TEST(Lanterns, HangInTheAtrium) {
    const Scene &scene = scene_of("lanterns"), &atrium = scene_of("atrium");
    ASSERT_GT(scene.instances.size(), atrium.instances.size());
    for (std::size_t i = 0; i < atrium.instances.size(); ++i) {
        EXPECT_EQ(scene.instances[i].world_from_object, atrium.instances[i].world_from_object);
    }
    EXPECT_EQ(scene.cameras.front().world_from_camera, atrium.cameras.front().world_from_camera);
}

TEST(Lanterns, AreLitByThemselvesAlone) {
    EXPECT_EQ(automatic_rig(scene_of("lanterns"), true), Rig::none);
    EXPECT_EQ(automatic_rig(scene_of("atrium"), true), Rig::swarm);
}

// Whether shadow rays to the light end before they meet the point of its mesh.
bool is_behind(const SceneLight& light, const glm::dvec3& point) {
    const glm::dvec3 from = point - light.position;
    if (light.type == LightType::sphere) return glm::length(from) < light.radius;
    return glm::dot(from, light.direction) < -1e-3;
}

TEST(Lanterns, GlowWithMeshesThatHideNothingOfTheirLights) {
    const Scene& scene = scene_of("lanterns");
    int glowing = 0;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        const Material& material = material_of(scene, mesh);
        // The panes of the atrium's own lanterns hang from the vault by their chain.
        if (material.emissive == glm::vec3(0.0f) || material.name == "glass") continue;
        const glm::dvec3 at(instance.world_from_object[3]);
        const auto light = std::ranges::find(scene.lights, at, &SceneLight::position);
        ASSERT_NE(light, scene.lights.end()) << mesh.name;
        ++glowing;
        for (const glm::vec3& p : mesh.positions) {
            const glm::dvec3 point(instance.world_from_object * glm::dvec4(p, 1.0));
            ASSERT_TRUE(is_behind(*light, point)) << mesh.name;
        }
    }
    EXPECT_EQ(glowing, 263 - 10 - 1) << "all but those in the atrium's lanterns and the moon";
}

}  // namespace
}  // namespace kilolux
