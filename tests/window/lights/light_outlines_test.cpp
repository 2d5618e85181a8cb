// SPDX-License-Identifier: Apache-2.0
#include "present/window/overlay/light_outlines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "host/scene/lights/light_kinds.h"
#include "host/scene/lights/light_shape.h"
#include "tests/support/box_scene.h"

namespace kilolux {
namespace {

SceneLight flat_light(LightType type) {
    SceneLight light;
    light.type = type;
    light.position = {1.0, 2.0, -5.0};
    light.direction = {0.0, -1.0, 0.0};
    light.side = {1.0, 0.0, 0.0};
    light.width = 2.0f;
    light.height = 0.5f;
    return light;
}

SceneLight sphere_light(float radius) {
    SceneLight light;
    light.type = LightType::sphere;
    light.position = {1.0, 2.0, -5.0};
    light.radius = radius;
    return light;
}

Camera camera_at(const glm::dvec3& position) {
    return look_at(position, {1.0, 2.0, -5.0}, {0.0, 1.0, 0.0}, 0.8);
}

TEST(LightOutlines, AreTheEdgesOfRectanglesAndTriangles) {
    const SceneLight rectangle = flat_light(LightType::rectangle);
    std::set<std::pair<double, double>> seen;
    for (const glm::dvec3& p : outline_of(rectangle, {})) {
        seen.insert({p.x, p.z});
        EXPECT_DOUBLE_EQ(p.y, 2.0);
    }
    EXPECT_EQ(seen, (std::set<std::pair<double, double>>{
                        {0.0, -5.25}, {0.0, -4.75}, {2.0, -5.25}, {2.0, -4.75}}));
    SceneLight triangle;
    const std::vector<glm::dvec3> corners = {{1, 1, -3}, {2, 1, -4}, {1.5, 2, -3.5}};
    set_triangle(triangle, corners[0], corners[1], corners[2]);
    const std::vector<glm::dvec3> outline = outline_of(triangle, {});
    ASSERT_EQ(outline.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(glm::length(outline[i] - corners[i]), 1e-6) << i;
}

TEST(LightOutlines, AreEllipsesOfDisks) {
    const std::vector<glm::dvec3> outline = outline_of(flat_light(LightType::disk), {});
    ASSERT_GT(outline.size(), 8u);
    for (const glm::dvec3& p : outline) {
        const double x = (p.x - 1.0) / 1.0, z = (p.z + 5.0) / 0.25;
        EXPECT_NEAR(x * x + z * z, 1.0, 1e-12);
        EXPECT_DOUBLE_EQ(p.y, 2.0);
    }
}

// Where a line from the eye touches the sphere.
TEST(LightOutlines, AreSilhouettesOfSpheres) {
    const SceneLight light = sphere_light(0.75f);
    for (const glm::dvec3 position : {glm::dvec3(1, 2, 3), {4, 3, -5}, {1, 2.8, -5.1}}) {
        Camera camera = camera_at(position);
        for (const bool orthographic : {false, true}) {
            camera.orthographic = orthographic;
            const std::vector<glm::dvec3> outline = outline_of(light, camera);
            ASSERT_FALSE(outline.empty());
            for (const glm::dvec3& p : outline) {
                const glm::dvec3 out = p - light.position;
                const glm::dvec3 ray =
                    orthographic ? glm::dvec3(camera.world_from_view[2]) : p - camera.position;
                EXPECT_NEAR(glm::length(out), 0.75, 1e-12);
                EXPECT_NEAR(glm::dot(out, ray), 0.0, 1e-12);
            }
        }
    }
    EXPECT_TRUE(outline_of(sphere_light(20.0f), camera_at({1, 2, 3})).empty()) << "around the eye";
}

TEST(LightOutlines, LightsWithoutASizeHaveNone) {
    for (const LightKind& kind : kLightKinds) {
        SceneLight light = flat_light(kind.type);
        light.radius = 0.5f;
        EXPECT_EQ(outline_of(light, camera_at({1, 2, 3})).empty(), !is_area_light(light))
            << kind.name;
    }
}

TEST(LightOutlines, AreThoseOfTheNearest) {
    std::vector<SceneLight> lights;
    for (const double z : {-9.0, -2.0, -7.0, -1.0, -4.0}) {
        lights.push_back(sphere_light(0.5f));
        lights.back().position = {0.0, 0.0, z};
    }
    lights[3].type = LightType::point;
    const std::span<const SceneLight> all(lights);
    // By their numbers, of the scene's own (the first `own`) and of generated ones.
    const auto nearest = [&](std::size_t own, std::size_t most) {
        std::vector<std::ptrdiff_t> out;
        for (const SceneLight* light :
             nearest_area_lights(all.first(own), all.subspan(own), {}, most)) {
            out.push_back(light - all.data());
        }
        std::ranges::sort(out);
        return out;
    };
    for (const std::size_t own : {5u, 2u, 0u}) {
        EXPECT_EQ(nearest(own, 9), (std::vector<std::ptrdiff_t>{0, 1, 2, 4}));
        EXPECT_EQ(nearest(own, 3), (std::vector<std::ptrdiff_t>{1, 2, 4}));
        EXPECT_EQ(nearest(own, 0), std::vector<std::ptrdiff_t>{});
    }
}

TEST(LightOutlines, AreThoseOfTheNearestGeneratedLights) {
    const Scene scene = box_scene({6.0, 3.0, 6.0}, true);
    LightSearch wanted;
    wanted.options.count = 300;
    wanted.options.size = 0.125;
    wanted.time = 7.5;
    wanted.camera = camera_at({1.0, 0.5, 2.0});
    std::vector<SceneLight> all = generate_lights(wanted.options, scene, wanted.time);
    std::ranges::sort(all, {}, [&](const SceneLight& light) {
        return glm::length(light.position - wanted.camera.position);
    });
    for (const std::size_t most : {0u, 1u, 40u, 300u, 1000u}) {
        const std::size_t count = std::min<std::size_t>(most, 300);
        const auto found = nearest_generated_lights(wanted, scene, most);
        ASSERT_EQ(found.size(), count);
        for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(std::ranges::count(found, all[i]), 1);
    }
    const auto none = [&](auto change) {
        LightSearch changed = wanted;
        change(changed.options);
        return nearest_generated_lights(changed, scene, 40).empty();
    };
    EXPECT_TRUE(none([](LightOptions& options) { options.size = 0.0; }));
    EXPECT_TRUE(none([](LightOptions& options) { options.count = 0; }));
    EXPECT_TRUE(none([](LightOptions& options) { options.count = kMostSearched + 1; }));
}

}  // namespace
}  // namespace kilolux
