// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/own_lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "host/scene/lights/light_kinds.h"
#include "tests/support/box_scene.h"

namespace kilolux {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

SceneLight light_of(LightType type) {
    SceneLight light;
    light.type = type;
    light.position = {1.0, 2.0, 3.0};
    for (const LightNumber& number : kLightNumbers) {
        if (kind_of(light).*number.has) light.*number.member = 0.5f;
    }
    if (kind_of(light).has_cone) light.inner_cone = 0.25f;
    return light;
}

std::vector<SceneLight> one_of_each() {
    std::vector<SceneLight> out;
    for (const LightKind& kind : kLightKinds) out.push_back(light_of(kind.type));
    return out;
}

// What the renderer's thread does with changes that it takes.
void send(OwnLights& own, AnimatedScene& scene) {
    scene.exchange_lights(own.begin_sending());
    own.end_sending(true);
}

TEST(OwnLights, CountsTheirKinds) {
    std::vector<SceneLight> lights = one_of_each();
    lights.push_back(light_of(LightType::disk));
    const OwnLights own(lights, 0.0);
    for (const LightKind& kind : kLightKinds) {
        EXPECT_EQ(own.count(kind.type), kind.type == LightType::disk ? 2u : 1u) << kind.name;
    }
    EXPECT_FALSE(own.has_unranged());
}

TEST(OwnLights, TakesEveryNumberOfEveryKind) {
    for (const LightKind& kind : kLightKinds) {
        for (const LightNumber& number : kLightNumbers) {
            if (!(kind.*number.has)) continue;
            SCOPED_TRACE(std::string(kind.name) + " " + number.name);
            OwnLights own({light_of(kind.type)}, 0.0);
            SceneLight next = own.lights()[0];
            next.*number.member = 0.375f;
            EXPECT_TRUE(own.change(0, next));
            EXPECT_EQ(own.lights()[0].*number.member, 0.375f);
            EXPECT_TRUE(own.is_changed(0) && own.has_news());
        }
    }
}

TEST(OwnLights, KeepsTheLastGoodValue) {
    for (const LightKind& kind : kLightKinds) {
        for (const LightNumber& number : kLightNumbers) {
            if (!(kind.*number.has)) continue;
            std::vector<float> bad = {kNan, std::numeric_limits<float>::infinity()};
            if (number.is_positive) bad.push_back(-1.0f);
            // A range of 0 is none.
            if (number.is_positive && number.member != &SceneLight::range) bad.push_back(0.0f);
            for (const float value : bad) {
                SCOPED_TRACE(std::string(kind.name) + " " + number.name);
                OwnLights own({light_of(kind.type)}, 0.0);
                SceneLight next = own.lights()[0];
                next.*number.member = value;
                EXPECT_FALSE(own.change(0, next)) << value;
                EXPECT_EQ(own.lights()[0], light_of(kind.type));
                EXPECT_FALSE(own.is_changed(0) || own.has_news());
            }
        }
    }
    OwnLights own({light_of(LightType::spot)}, 0.0);
    const auto refuses = [&](auto change) {
        SceneLight next = own.lights()[0];
        change(next);
        return !own.change(0, next);
    };
    EXPECT_TRUE(refuses([](SceneLight& light) { light.intensity.y = kNan; }));
    EXPECT_TRUE(refuses([](SceneLight& light) { light.intensity.y = -1.0f; }));
    EXPECT_TRUE(refuses([](SceneLight& light) { light.position.z = std::nan(""); }));
    EXPECT_TRUE(refuses([](SceneLight& light) { light.direction = glm::dvec3(0.0); }));
    EXPECT_TRUE(refuses([](SceneLight& light) { light.inner_cone = light.outer_cone; }));
    EXPECT_FALSE(refuses([](SceneLight& light) { light.intensity = glm::vec3(0.0f); })) << "dark";
}

TEST(OwnLights, AreResetToThoseOfTheFile) {
    OwnLights own(one_of_each(), 0.0);
    for (std::size_t i = 0; i < own.lights().size(); ++i) {
        for (const float shift : {1.0f, 2.0f}) {
            SceneLight next = own.lights()[i];
            next.intensity += glm::vec3(shift);
            EXPECT_TRUE(own.change(i, next));
        }
    }
    EXPECT_EQ(own.changed_count(), kLightKinds.size());
    own.reset(2);
    EXPECT_EQ(own.lights()[2], one_of_each()[2]);
    EXPECT_EQ(own.changed_count(), kLightKinds.size() - 1);
    SceneLight again = one_of_each()[1];
    EXPECT_TRUE(own.change(1, again));
    EXPECT_FALSE(own.is_changed(1)) << "as in the file";
    own.reset();
    EXPECT_EQ(own.lights(), one_of_each());
    EXPECT_EQ(own.changed_count(), 0u);
}

TEST(OwnLights, TheSceneFollows) {
    Scene source = box_scene({2.0, 2.0, 2.0});
    source.lights = one_of_each();
    AnimatedScene scene(source);
    scene.add_lights({light_of(LightType::directional)});
    OwnLights own({scene.own_lights().begin(), scene.own_lights().end()}, 0.0);
    EXPECT_EQ(own.lights(), one_of_each()) << "none of the added ones";
    const auto dim = [&](std::size_t light, float factor) {
        SceneLight next = own.lights()[light];
        next.intensity *= factor;
        EXPECT_TRUE(own.change(light, next));
    };
    const std::uint32_t revision = scene.scene().revisions.lights;
    dim(3, 0.5f);
    dim(3, 0.5f);
    dim(5, 0.25f);
    send(own, scene);
    EXPECT_FALSE(own.has_news());
    EXPECT_GT(scene.scene().revisions.lights, revision);
    EXPECT_TRUE(std::ranges::equal(scene.own_lights(), own.lights()));
    EXPECT_EQ(scene.added_lights().size(), 1u);
    EXPECT_EQ(scene.scene().lights[3].intensity, glm::vec3(0.25f));
    own.reset();
    send(own, scene);
    EXPECT_TRUE(std::ranges::equal(scene.own_lights(), one_of_each()));
}

TEST(OwnLights, AreThoseOfTheSceneWhereItRefusesChanges) {
    OwnLights own(one_of_each(), 0.0);
    SceneLight first = own.lights()[4];
    first.width = 0.75f;
    EXPECT_TRUE(own.change(4, first));
    own.begin_sending();
    own.end_sending(true);
    SceneLight second = first;
    second.width = 0.875f;
    EXPECT_TRUE(own.change(4, second));
    own.set_point_size(0.125);
    own.begin_sending();
    own.end_sending(false);
    EXPECT_EQ(own.lights()[4], first);
    EXPECT_EQ(own.lights()[0], one_of_each()[0]);
    EXPECT_EQ(own.point_size(), 0.0);
    EXPECT_EQ(own.changed_count(), 1u);
    EXPECT_FALSE(own.has_news());
}

// The user asks for another size of points while a change of another light is on its way.
TEST(OwnLights, PointsHaveTheScenesSizeWhereItRefusesEarlierChanges) {
    OwnLights own(one_of_each(), 0.0);
    own.set_point_size(0.125);
    own.begin_sending();
    own.end_sending(true);
    const std::vector<SceneLight> of_scene = own.lights();
    SceneLight wider = of_scene[4];
    wider.width = 0.75f;
    EXPECT_TRUE(own.change(4, wider));
    EXPECT_EQ(own.begin_sending().size(), 1u);
    own.set_point_size(0.25);
    own.end_sending(false);
    EXPECT_EQ(own.point_size(), 0.125);
    EXPECT_EQ(own.lights(), of_scene);
    for (const NumberedLight& sent : own.begin_sending()) {
        EXPECT_EQ(sent.light, of_scene[sent.number]) << sent.number;
    }
    own.end_sending(true);
    own.set_point_size(0.25);
    EXPECT_EQ(own.lights()[0].radius, 0.25f) << "it can be asked for again";
}

TEST(OwnLights, PointsGetTheSizeThatIsAskedForAndNoOthers) {
    std::vector<SceneLight> lights = one_of_each();
    lights.push_back(light_of(LightType::point));
    lights.back().profile = 0;
    OwnLights own(lights, 0.0);
    SceneLight bright = own.lights()[0];
    bright.intensity = glm::vec3(7.0f);
    EXPECT_TRUE(own.change(0, bright));
    own.set_point_size(0.25);
    EXPECT_EQ(own.lights()[0].type, LightType::sphere);
    EXPECT_EQ(own.lights()[0].radius, 0.25f);
    EXPECT_EQ(own.lights()[0].intensity, glm::vec3(7.0f));
    for (std::size_t i = 1; i < lights.size(); ++i) EXPECT_EQ(own.lights()[i], lights[i]) << i;
    own.set_point_size(0.5);
    EXPECT_EQ(own.lights()[0].radius, 0.5f);
    EXPECT_EQ(own.changed_count(), 1u);
    own.reset();
    EXPECT_EQ(own.lights()[0].radius, 0.5f) << "the size is no change of the light";
    own.set_point_size(0.0);
    EXPECT_EQ(own.lights(), lights);
    own.set_point_size(0.5);
    SceneLight sphere = own.lights()[0];
    sphere.radius = 0.75f;
    EXPECT_TRUE(own.change(0, sphere));
    own.set_point_size(0.25);
    EXPECT_EQ(own.lights()[0].radius, 0.75f) << "it has one of its own";
    own.reset(0);
    EXPECT_EQ(own.lights()[0].radius, 0.25f);
}

TEST(OwnLights, AreFoundByTheViewsMiddle) {
    std::vector<SceneLight> lights(4);
    lights[0].position = {3.0, 0.0, -4.0};
    lights[1].position = {0.5, 0.0, -40.0};
    lights[2].position = {0.2, 0.0, -4.0};
    lights[3].position = {0.0, 0.0, 1.0};  // behind
    Camera camera;
    EXPECT_EQ(light_in_view(lights, camera), 1);
    camera.orthographic = true;
    EXPECT_EQ(light_in_view(lights, camera), 2);
    camera.orthographic = false;
    camera.position = {0.0, 0.0, -90.0};
    EXPECT_EQ(light_in_view(lights, camera), 1) << "the nearest, as all are behind";
    for (SceneLight& light : lights) light.type = LightType::directional;
    EXPECT_EQ(light_in_view(lights, camera), -1);
    EXPECT_EQ(light_in_view({}, camera), -1);
}

}  // namespace
}  // namespace kilolux
