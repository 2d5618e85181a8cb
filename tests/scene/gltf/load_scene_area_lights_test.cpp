// SPDX-License-Identifier: Apache-2.0
// EXT_lights_area, and points with a radius.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "host/scene/gltf/load_scene.h"
#include "host/scene/lights/light_kinds.h"
#include "host/scene/lights/light_shape.h"
#include "tests/scene/expect_near.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

using nlohmann::json;

const json kToPlusX = {0, -std::sqrt(0.5), 0, std::sqrt(0.5)};  // -Z becomes +X

GltfBuilder file_of_light(std::string_view extension, const json& light, const json& node) {
    GltfBuilder file;
    const std::string name(extension);
    file.root["extensions"][name]["lights"] = {light};
    json placed = node;
    placed["extensions"][name]["light"] = 0;
    file.add_node(placed);
    return file;
}

SceneLight area_light(const json& light, const json& node = json::object()) {
    return load(file_of_light(kArea, light, node)).lights.at(0);
}

SceneLight point_with(const json& extras, double light_size = 0.0, const char* type = "point") {
    LoadOptions options;
    options.light_size = light_size;
    const json light = {{"type", type}, {"intensity", 40}, {"extras", extras}};
    return load(file_of_light(kPunctual, light, json::object()), options).lights.at(0);
}

std::string light_warning(const GltfBuilder& file) {
    testing::internal::CaptureStderr();
    load(file);
    return testing::internal::GetCapturedStderr();
}

TEST(LoadSceneAreaLights, HaveTheDefaultsOfTheExtension) {
    const SceneLight rectangle = area_light({{"type", "rect"}});
    EXPECT_EQ(rectangle.type, LightType::rectangle);
    EXPECT_EQ(rectangle.width, 1.0f);
    EXPECT_EQ(rectangle.height, 1.0f);
    EXPECT_EQ(rectangle.intensity, glm::vec3(1000)) << "1000 nits on 1 m^2";
    EXPECT_EQ(rectangle.range, 0.0f);
    EXPECT_FALSE(rectangle.two_sided);
    expect_near(rectangle.direction, {0, 0, -1});
    const SceneLight disk = area_light({{"type", "disk"}});
    EXPECT_EQ(disk.type, LightType::disk);
    EXPECT_EQ(disk.width, 1.0f) << "its diameter";
    EXPECT_FLOAT_EQ(disk.intensity.x, 250.0f * glm::pi<float>());
}

TEST(LoadSceneAreaLights, ReadAllProperties) {
    const json light = {{"type", "rect"},          {"color", {1, 0.5, 0.25}},
                        {"intensity", 40},         {"size", 0.5},
                        {"rect", {{"aspect", 3}}}, {"extras", {{"twoSided", true}, {"range", 7}}}};
    const SceneLight out = area_light(light, {{"translation", {1, 2, 3}}, {"rotation", kToPlusX}});
    expect_near(out.position, {1, 2, 3});
    expect_near(out.direction, {1, 0, 0});
    expect_near(out.side, {0, 0, 1});
    EXPECT_EQ(out.height, 0.5f);
    EXPECT_EQ(out.width, 1.5f);
    EXPECT_EQ(out.intensity, glm::vec3(30, 15, 7.5f));
    EXPECT_EQ(out.range, 7.0f);
    EXPECT_TRUE(out.two_sided);
}

// The text: by the largest of the three, whatever its sign.
TEST(LoadSceneAreaLights, GrowWithTheLargestScaleOfTheirNode) {
    const json light = {
        {"type", "rect"}, {"intensity", 10}, {"size", 0.5}, {"rect", {{"aspect", 3}}}};
    for (const json& scale : {json{2, 3, 4}, json{-4, 1, 0.5}, json{1, -4, 1}}) {
        const SceneLight out = area_light(light, {{"scale", scale}});
        EXPECT_EQ(out.height, 2.0f) << scale;
        EXPECT_EQ(out.width, 6.0f) << scale;
        EXPECT_EQ(out.intensity.x, 120.0f) << "its luminance stays";
        expect_near(out.direction, {0, 0, -1});
    }
}

TEST(LoadSceneAreaLights, ShineAlongTheNodesOwnAxisWhereItIsMirrored) {
    for (const json& scale : {json{-1, 1, 1}, json{1, -1, 1}, json{1, 1, -1}, json{-1, -1, -1}}) {
        const SceneLight out =
            area_light({{"type", "disk"}}, {{"rotation", kToPlusX}, {"scale", scale}});
        expect_near(out.direction, {scale[2].get<double>(), 0, 0});
        EXPECT_NEAR(glm::dot(out.direction, out.side), 0.0, 1e-12);
        EXPECT_NEAR(glm::dot(glm::cross(edges_of(out).x, edges_of(out).y), out.direction),
                    seen_area(out) / glm::pi<double>(), 1e-12);
    }
}

TEST(LoadSceneAreaLights, AreSpheresWherePointsHaveARadius) {
    const SceneLight sphere = point_with({{"radius", 0.25}});
    EXPECT_EQ(sphere.type, LightType::sphere);
    EXPECT_EQ(sphere.radius, 0.25f);
    EXPECT_EQ(sphere.intensity, glm::vec3(40));
    for (const json& none :
         {json::object(), json{{"radius", 0}}, json("soft"), json{{"radius", "a"}}}) {
        EXPECT_EQ(point_with(none).type, LightType::point) << none;
        EXPECT_EQ(point_with(none).radius, 0.0f) << none;
    }
}

TEST(LoadSceneAreaLights, GetTheRadiusThatIsAskedForWhereTheyHaveNone) {
    const SceneLight sphere = point_with(json::object(), 0.5);
    EXPECT_EQ(sphere.type, LightType::sphere);
    EXPECT_EQ(sphere.radius, 0.5f);
    EXPECT_EQ(sphere.intensity, glm::vec3(40));
    EXPECT_TRUE(sphere.is_sized_point);
    EXPECT_EQ(point_with({{"radius", 0.25}}, 0.5).radius, 0.25f);
    EXPECT_FALSE(point_with({{"radius", 0.25}}, 0.5).is_sized_point) << "a radius of its own";
    EXPECT_EQ(point_with(json::object(), 0.5, "spot").type, LightType::spot);
    EXPECT_EQ(point_with(json::object(), 0.5, "directional").type, LightType::directional);
}

TEST(LoadSceneAreaLights, WithBadValuesAreRefusedInOneLine) {
    const auto error = [](const json& light) {
        return load_error(file_of_light(kArea, light, json::object()));
    };
    const std::string place = "extensions.EXT_lights_area.lights[0].";
    EXPECT_TRUE(contains(error({{"type", "sphere"}}), place + "type is \"sphere\""));
    EXPECT_TRUE(contains(error({{"size", 1}}), place + "type"));
    EXPECT_TRUE(contains(error({{"type", "disk"}, {"size", "1"}}), place + "size is \"1\""));
    EXPECT_TRUE(
        contains(error({{"type", "rect"}, {"rect", {{"aspect", true}}}}), "rect.aspect is true"));
    EXPECT_TRUE(contains(error({{"type", "rect"}, {"intensity", {1}}}), place + "intensity"));
    GltfBuilder file = file_of_light(kArea, {{"type", "rect"}}, json::object());
    file.root["nodes"][0]["extensions"]["EXT_lights_area"]["light"] = 3;
    EXPECT_TRUE(contains(load_error(file), "light is 3, must be an index into the 1 lights"))
        << load_error(file);
}

TEST(LoadSceneAreaLights, WithoutASizeAreReported) {
    const auto warning = [](const json& light) {
        return light_warning(file_of_light(kArea, light, json::object()));
    };
    EXPECT_EQ(warning({{"type", "rect"}, {"rect", {{"aspect", 0.5}}}}), "");
    EXPECT_TRUE(contains(warning({{"type", "disk"}, {"size", 0}}),
                         "lights[0]: height is 0, must be above 0\n"));
    EXPECT_TRUE(contains(warning({{"type", "rect"}, {"rect", {{"aspect", -2}}}}),
                         "lights[0]: width is -2, must be above 0\n"));
}

TEST(LoadSceneAreaLights, ReportARadiusThatCannotBe) {
    const auto warning = [](const char* type, const json& radius) {
        const json light = {{"type", type}, {"extras", {{"radius", radius}}}};
        return light_warning(file_of_light(kPunctual, light, json::object()));
    };
    EXPECT_EQ(warning("point", 0.5), "");
    EXPECT_EQ(warning("spot", 0), "");
    EXPECT_TRUE(contains(warning("spot", 0.5),
                         "lights[0]: extras.radius: a light of type \"spot\" has none here"));
    EXPECT_TRUE(
        contains(warning("point", -1), "lights[0]: extras.radius is -1, must be at least 0\n"));
    EXPECT_TRUE(contains(warning("point", "a"), "lights[0]: extras.radius must be a number\n"));
}

}  // namespace
}  // namespace kilolux
