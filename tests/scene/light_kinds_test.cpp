// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/light_kinds.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/scene/lights/rig.h"

namespace kilolux {
namespace {

TEST(LightKinds, AreFoundInTheirExtensionOnly) {
    for (const LightKind& kind : kLightKinds) {
        EXPECT_EQ(find_light_kind(kind.extension, kind.name), &kind);
        EXPECT_EQ(find_light_kind("EXT_lights_image_based", kind.name), nullptr);
    }
    EXPECT_EQ(find_light_kind(kPunctual, "area"), nullptr);
}

TEST(LightKinds, HaveTheNumbersOfTheirExtensionOnly) {
    for (const LightNumber& number : kLightNumbers) {
        EXPECT_TRUE(has_number(kPunctual, number)) << number.path;
        EXPECT_FALSE(has_number("EXT_lights_image_based", number)) << number.path;
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
