// SPDX-License-Identifier: Apache-2.0
// The places of generated lights in scenes of any size and shape, and their least distance.
#include "host/scene/lights/light_region.h"

#include <gtest/gtest.h>

#include "host/scene/enclosure.h"
#include "host/scene/generated/scenes.h"
#include "host/scene/lights/light_generator.h"
#include "tests/support/box_scene.h"

namespace kilolux {
namespace {

constexpr double kSizes[] = {1e-3, 1e-2, 1.0, 1e4};  // [m]

bool holds(const Box& box, const glm::dvec3& p) {
    return glm::all(glm::greaterThan(p, box.min)) && glm::all(glm::lessThan(p, box.max));
}

// Distance from a point outside a box to it.
double distance_to(const Box& box, const glm::dvec3& p) {
    return glm::length(glm::max(glm::max(box.min - p, p - box.max), glm::dvec3(0.0)));
}

TEST(LightRegion, LightsStandAroundAClosedObjectAtEveryScale) {
    for (const double size : kSizes) {
        const Scene scene = box_scene(glm::dvec3(size));
        ASSERT_EQ(scene.kind, SceneKind::closed) << size;
        for (const std::uint64_t count : {1u, 7u, 5000u}) {
            LightOptions options;
            options.count = count;
            const double range = automatic_light_scale(options, scene).radius;
            for (const double time : {0.0, 3.5, 1e4}) {
                for (const SceneLight& light : generate_lights(options, scene, time)) {
                    const double away = distance_to(bounds(scene), light.position);
                    ASSERT_GE(away, 0.999 * std::min(0.25 * range, 0.05 * std::sqrt(3.0) * size));
                    ASSERT_LE(away, std::sqrt(3.0) * 0.31 * std::sqrt(3.0) * size);
                }
            }
        }
    }
}

TEST(LightRegion, AllSidesOfAnObjectAreLitAlike) {
    const Scene scene = box_scene(glm::dvec3(2.0));
    int sides[3][2] = {};
    for (const SceneLight& light : generate_lights({}, scene, 0.0)) {
        for (int axis = 0; axis < 3; ++axis) {
            if (std::abs(light.position[axis]) > 1.0) ++sides[axis][light.position[axis] > 0.0];
        }
    }
    for (const auto& side : sides) {
        // Of 5000 lights a side's slab has a third of the shell at least: within 4 sigma, 140.
        EXPECT_NEAR(side[0], side[1], 280);
        EXPECT_GT(side[0], 1000);
    }
}

TEST(LightRegion, AFlatSceneHasItsLightsOffTheSurface) {
    for (const double size : kSizes) {
        const Scene scene = box_scene({size, 0.0, size});
        LightOptions options;
        const double range = automatic_light_scale(options, scene).radius;
        for (const SceneLight& light : generate_lights(options, scene, 2.0)) {
            const double away = distance_to(bounds(scene), light.position);
            ASSERT_GE(away, 0.999 * std::min(0.25 * range, 0.05 * std::sqrt(2.0) * size)) << size;
        }
    }
}

TEST(LightRegion, AnInteriorHasItsLightsWithinItsWalls) {
    const Scene scene = box_scene({20.0, 5.0, 8.0}, true);
    ASSERT_EQ(scene.kind, SceneKind::interior);
    const Box room{{-9.6, -2.4, -3.84}, {9.6, 2.4, 3.84}};
    for (const SceneLight& light : generate_lights({}, scene, 77.0)) {
        ASSERT_LE(distance_to(room, light.position), 1e-9);
    }
}

TEST(LightRegion, AnOpenSceneHasLightsAmongItsSurfaces) {
    Scene scene = box_scene(glm::dvec3(1.0));
    scene.instances.push_back(scene.instances[0]);
    scene.instances[0].world_from_object[3] = {-3.0, 0.0, -3.0, 1.0};
    scene.instances[1].world_from_object[3] = {3.0, 2.0, 3.0, 1.0};
    scene.still_box = {};
    scene.kind = enclosure_of(scene, bounds(scene)).kind;
    EXPECT_EQ(scene.kind, SceneKind::open);
    const LightRegion region = light_region(scene, 0.0);
    EXPECT_TRUE(region.hole.empty());
    EXPECT_TRUE(holds(region.outer, {0, 0, 0}));
}

TEST(LightRegion, RangesAndPlacesScaleWithTheScene) {
    const Scene unit = box_scene(glm::dvec3(1.0));
    const auto lights = generate_lights({}, unit, 0.0);
    for (const double size : kSizes) {
        const auto scaled = generate_lights({}, box_scene(glm::dvec3(size)), 0.0);
        for (std::size_t i = 0; i < lights.size(); i += 97) {
            EXPECT_LE(glm::length(scaled[i].position / size - lights[i].position), 1e-6);
            EXPECT_NEAR(scaled[i].range / size, lights[i].range, 1e-5);
            EXPECT_NEAR(scaled[i].intensity.x / (size * size) / lights[i].intensity.x, 1.0, 1e-5);
        }
    }
}

TEST(LightRegion, TheLeastDistanceIsAFractionOfASmallScene) {
    for (const char* name : {"atrium", "grid", "plain", "corridor"}) {
        EXPECT_EQ(light_d_min(make_generated_scene(name)), 0.01f) << name;
    }
    EXPECT_EQ(light_d_min(Scene{}), 0.01f);
    EXPECT_EQ(light_d_min(box_scene(glm::dvec3(1e4))), 0.01f);
    for (const double size : {1.0, 0.1, 0.01, 1e-3, 1e-6}) {
        const double diagonal = std::sqrt(3.0) * size;
        const float d_min = light_d_min(box_scene(glm::dvec3(size)));
        EXPECT_LE(d_min, diagonal / 400.0) << size;
        EXPECT_GT(d_min, diagonal / 801.0) << size;
        EXPECT_EQ(std::exp2(std::round(std::log2(0.01f / d_min))), 0.01f / d_min) << size;
    }
}

}  // namespace
}  // namespace kilolux
