// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/light_aim.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/scene/lights/light_shape.h"

namespace kilolux {
namespace {

SceneLight light_along(const glm::dvec3& direction, const glm::dvec3& side) {
    SceneLight light;
    light.type = LightType::rectangle;
    light.width = 2.0f;
    light.height = 1.0f;
    light.direction = glm::normalize(direction);
    light.side = glm::normalize(side);
    return light;
}

void expect_aim(const LightAim& aim, const LightAim& expected) {
    EXPECT_NEAR(aim.azimuth, expected.azimuth, 1e-9);
    EXPECT_NEAR(aim.elevation, expected.elevation, 1e-9);
    EXPECT_NEAR(aim.roll, expected.roll, 1e-9);
}

TEST(LightAim, HasTheAnglesOfAxes) {
    expect_aim(aim_of(light_along({0, 0, -1}, {1, 0, 0})), {0, 0, 0});
    expect_aim(aim_of(light_along({1, 0, 0}, {0, 0, 1})), {90, 0, 0});
    expect_aim(aim_of(light_along({-1, 0, 0}, {0, 0, -1})), {-90, 0, 0});
    expect_aim(aim_of(light_along({0, 1, -1}, {1, 0, 0})), {0, 45, 0});
    expect_aim(aim_of(light_along({0, 0, -1}, {0, 1, 0})), {0, 0, 90});
    EXPECT_NEAR(std::abs(aim_of(light_along({0, 0, 1}, {-1, 0, 0})).azimuth), 180.0, 1e-9);
}

// Rounding of a file's direction chooses no azimuth.
TEST(LightAim, HasNoAzimuthStraightUpAndDown) {
    expect_aim(aim_of(light_along({0, -1, 0}, {1, 0, 0})), {0, -90, 0});
    expect_aim(aim_of(light_along({1e-8, -1, 1e-8}, {1, 0, 0})), {0, -90, 0});
    expect_aim(aim_of(light_along({0, -1, 0}, {0, 0, -1})), {0, -90, 90});
    expect_aim(aim_of(light_along({0, 1, 0}, {0, 0, 1})), {0, 90, 90});
}

TEST(LightAim, SetsUnitAxesWithTheseAngles) {
    SceneLight light = light_along({0, 0, -1}, {1, 0, 0});
    for (const double azimuth : {-180.0, -75.0, 0.0, 30.0, 90.0}) {
        for (const double elevation : {-89.0, -90.0, -20.0, 0.0, 60.0}) {
            for (const double roll : {-120.0, 0.0, 45.0}) {
                SCOPED_TRACE(testing::Message() << azimuth << " " << elevation << " " << roll);
                set_aim(light, {azimuth, elevation, roll});
                EXPECT_NEAR(glm::length(light.direction), 1.0, 1e-15);
                EXPECT_NEAR(glm::length(light.side), 1.0, 1e-15);
                EXPECT_NEAR(glm::dot(light.direction, light.side), 0.0, 1e-15);
                SceneLight again = light;
                set_aim(again, aim_of(light));
                EXPECT_LT(glm::length(again.direction - light.direction), 1e-9);
                EXPECT_LT(glm::length(again.side - light.side), 1e-9);
            }
        }
    }
}

// A rectangle that is turned to and fro is where it was, and it is level all the way.
TEST(LightAim, TurnsAFlatLightWithItsRoll) {
    SceneLight light = light_along({0, 0, -1}, {1, 0, 0});
    for (const double azimuth : {45.0, 200.0, 355.0, 360.0}) {
        set_aim(light, {azimuth, -30.0, 0.0});
        EXPECT_NEAR(edges_of(light).x.y, 0.0, 1e-15) << azimuth;
        EXPECT_NEAR(edges_of(light).y.y, -0.5 * std::cos(glm::radians(30.0)), 1e-12) << azimuth;
    }
    EXPECT_LT(glm::length(light.side - glm::dvec3(1, 0, 0)), 1e-12);
    EXPECT_EQ(light.width, 2.0f);
    EXPECT_EQ(light.type, LightType::rectangle);
}

}  // namespace
}  // namespace kilolux
