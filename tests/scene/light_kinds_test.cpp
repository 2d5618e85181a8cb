// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/light_kinds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/scene/lights/light_shape.h"
#include "host/scene/lights/rig.h"

namespace kilolux {
namespace {

TEST(LightKinds, AreFoundInTheirExtensionOnly) {
    for (const LightKind& kind : kLightKinds) {
        const bool in_files = !kind.extension.empty();
        for (const std::string_view extension : kLightExtensions) {
            const bool own = extension == kind.extension;
            EXPECT_EQ(find_light_kind(extension, kind.name_in_file, kind.has_radius) == &kind, own)
                << kind.name;
        }
        EXPECT_EQ(find_light_kind("EXT_lights_image_based", kind.name_in_file), nullptr);
        EXPECT_EQ(in_files, !kind.name_in_file.empty()) << kind.name;
    }
    EXPECT_EQ(find_light_kind(kPunctual, "area"), nullptr);
    EXPECT_EQ(find_light_kind(kPunctual, "sphere"), nullptr);
    EXPECT_EQ(find_light_kind(kPunctual, "spot", true), nullptr);
}

// A number in a file is one that some kind of the extension has.
TEST(LightKinds, HaveTheNumbersOfTheirExtensionOnly) {
    for (const LightNumber& number : kLightNumbers) {
        for (std::size_t e = 0; e < kLightExtensions.size(); ++e) {
            const bool has = std::ranges::any_of(kLightKinds, [&](const LightKind& kind) {
                return kind.extension == kLightExtensions[e] && kind.*number.has;
            });
            EXPECT_TRUE(has || number.paths[e].empty()) << number.name;
        }
    }
}

TEST(LightKinds, WithASizeHaveAnAreaAndFeatures) {
    for (const LightKind& kind : kLightKinds) {
        SceneLight light;
        light.type = kind.type;
        light.width = light.height = light.radius = 2.0f;
        const bool has_size = kind.shape != SHAPE_POINT;
        EXPECT_EQ(seen_area(light) > 0.0, has_size) << kind.name;
        EXPECT_EQ(bounding_radius(light) > 0.0, has_size) << kind.name;
        EXPECT_EQ(size_problem(light), "") << kind.name;
        light.width = 0.0f;
        EXPECT_EQ(size_problem(light).empty(), !kind.is_flat) << kind.name;
        for (const bool two_sided : {false, true}) {
            SceneFeatures features;
            light.two_sided = two_sided;
            add_features(features, light);
            EXPECT_EQ(features.area_lights, has_size) << kind.name;
            EXPECT_EQ(features.spot_lights, kind.has_cone || (kind.is_flat && !two_sided));
        }
    }
}

TEST(LightShapes, OfTrianglesHaveTheirCorners) {
    const glm::dvec3 a(1.0, 2.0, 3.0), b(1.5, 2.25, 3.0), c(0.75, 4.0, 2.5);
    SceneLight light;
    set_triangle(light, a, b, c);
    const LightEdges edges = edges_of(light);
    EXPECT_LE(glm::distance(edges.x, b - a), 1e-6);
    EXPECT_LE(glm::distance(edges.y, c - a), 1e-6);
    EXPECT_LE(glm::distance(light.position, (a + b + c) / 3.0), 1e-12);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    EXPECT_NEAR(glm::dot(light.direction, glm::normalize(normal)), 1.0, 1e-12);
    EXPECT_NEAR(seen_area(light), 0.5 * glm::length(normal), 1e-6);
    double radius = 0.0;
    for (const glm::dvec3& corner : {a, b, c}) {
        radius = std::max(radius, glm::distance(corner, light.position));
    }
    EXPECT_NEAR(bounding_radius(light), radius, 1e-6);
    set_triangle(light, a, b, a + 2.0 * (b - a));
    EXPECT_EQ(light.direction, glm::dvec3(0.0)) << "which the renderer rejects";
    EXPECT_EQ(light, light) << "no NaN";
}

TEST(LightShapes, SpanTheWayOfTheLight) {
    for (const LightType type : {LightType::rectangle, LightType::disk, LightType::triangle}) {
        SceneLight light;
        light.type = type;
        light.direction = {0, -1, 0};
        light.side = {0.6, 0, 0.8};
        light.width = 3.0f;
        light.height = 0.5f;
        const LightEdges edges = edges_of(light);
        EXPECT_GT(glm::dot(glm::cross(edges.x, edges.y), light.direction), 0.1);
        EXPECT_NEAR(glm::dot(edges.x, light.side), type == LightType::triangle ? 3.0 : 1.5, 1e-12);
    }
}

TEST(RigLights, HaveASidePerpendicularToTheirDirection) {
    for (const Rig rig : {Rig::studio, Rig::headlight}) {
        for (const SceneLight& light : rig_lights(rig)) {
            EXPECT_NEAR(glm::dot(light.direction, light.side), 0.0, 1e-15);
            EXPECT_NEAR(glm::length(light.side), 1.0, 1e-15);
        }
    }
}

}  // namespace
}  // namespace kilolux
