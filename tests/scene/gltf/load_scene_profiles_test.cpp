// SPDX-License-Identifier: Apache-2.0
// EXT_lights_ies: lights with IES files, and where they point.
#include <gtest/gtest.h>

#include "tests/support/gltf_builder.h"
#include "tests/support/ies_text.h"
#include "tests/support/ldt_text.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

using nlohmann::json;

GltfBuilder file_with(const json& light, const json& node, const json& use) {
    GltfBuilder file = triangle_file();
    file.root["extensionsUsed"] = {"EXT_lights_ies"};
    file.root["extensions"]["EXT_lights_ies"]["lights"] = {light};
    json placed = node;
    placed["extensions"]["EXT_lights_ies"] = use;
    file.add_node(placed);
    return file;
}

Scene load_beside(const GltfBuilder& file, const std::string& ies) {
    const TempFolder folder;
    write_file(folder.path() / "lamp.ies", ies);
    write_file(folder.path() / "scene.gltf", file.gltf());
    return load_scene(folder.path() / "scene.gltf");
}

std::string error_beside(const json& light, const json& use, const std::string& ies) {
    const TempFolder folder;
    write_file(folder.path() / "lamp.ies", ies);
    write_file(folder.path() / "scene.gltf", file_with(light, json::object(), use).gltf());
    return load_error(folder.path() / "scene.gltf");
}

const json kFile = {{"uri", "lamp.ies"}, {"name", "lamp"}};

TEST(LoadSceneProfiles, LightsHaveThePeakTimesMultiplierAndColour) {
    const Scene scene =
        load_beside(file_with(kFile, {{"translation", {1, 2, 3}}},
                              {{"light", 0}, {"multiplier", 2.5}, {"color", {0.5, 1, 7}}}),
                    ies_text({}));
    ASSERT_EQ(scene.webs.size(), 1u);
    EXPECT_EQ(scene.webs[0].name, "lamp");
    ASSERT_EQ(scene.lights.size(), 1u);
    const SceneLight& light = scene.lights[0];
    EXPECT_EQ(light.type, LightType::point);
    EXPECT_EQ(light.position, glm::dvec3(1, 2, 3));
    EXPECT_EQ(light.intensity, glm::vec3(125.0f, 250.0f, 250.0f));
    EXPECT_EQ(light.range, 0.0f);
    EXPECT_EQ(light.profile, 0);
}

// Vertical angle 0 is the node's -Z, horizontal angle 0 its +X.
TEST(LoadSceneProfiles, TurnWithTheirNode) {
    const json use = {{"light", 0}};
    const Scene plain = load_beside(file_with(kFile, json::object(), use), ies_text({}));
    EXPECT_EQ(plain.lights[0].direction, glm::dvec3(0, 0, -1));
    EXPECT_EQ(plain.lights[0].side, glm::dvec3(1, 0, 0));
    EXPECT_FALSE(plain.aimed_profiles[0].mirrored);
    const double root = std::sqrt(0.5);  // a quarter turn about +Y: -Z to -X, +X to -Z
    const Scene turned = load_beside(
        file_with(kFile, {{"rotation", {0, root, 0, root}}, {"scale", {2, 3, 0.5}}}, use),
        ies_text({}));
    EXPECT_LE(glm::length(turned.lights[0].direction - glm::dvec3(-1, 0, 0)), 1e-12);
    EXPECT_LE(glm::length(turned.lights[0].side - glm::dvec3(0, 0, -1)), 1e-12);
    const Scene mirrored =
        load_beside(file_with(kFile, {{"scale", {1, -1, 1}}}, use), ies_text({}));
    EXPECT_TRUE(mirrored.aimed_profiles[0].mirrored);
}

// extras.group of the node counts before that of the photometric light.
TEST(LoadSceneProfiles, LightsAreInTheGroupOfTheirExtras) {
    const auto group = [](const json& light_extras, const json& node_extras) {
        json light = kFile, node = json::object();
        if (!light_extras.is_null()) light["extras"] = light_extras;
        if (!node_extras.is_null()) node["extras"] = node_extras;
        const Scene scene = load_beside(file_with(light, node, {{"light", 0}}), ies_text({}));
        return scene.light_nodes.at(static_cast<std::size_t>(scene.lights.at(0).node)).group;
    };
    const json street = {{"group", "street"}}, road = {{"group", "road"}};
    EXPECT_EQ(group({}, {}), "");
    EXPECT_EQ(group(street, {}), "street");
    EXPECT_EQ(group({}, road), "road");
    EXPECT_EQ(group(street, road), "road");
    EXPECT_EQ(group(street, {{"group", 7}}), "street");
    EXPECT_EQ(group({{"group", {1, 2}}}, {}), "");
    EXPECT_EQ(group(json{"group"}, json{"group"}), "");
}

// The file's content tells EULUMDAT from LM-63, whatever its name.
TEST(LoadSceneProfiles, FilesMayBeEulumdat) {
    const Scene scene =
        load_beside(file_with(kFile, json::object(), {{"light", 0}}), european(ldt_text({})));
    EXPECT_EQ(scene.webs[0].peak, 200.0);
    EXPECT_EQ(scene.lights[0].intensity, glm::vec3(200.0f));
}

TEST(LoadSceneProfiles, ANodeWithoutAxesGivesALightThatIsRejected) {
    for (const json& scale : {json{0, 0, 0}, json{0, 1, 1}, json{1, 1, 0}}) {
        const Scene scene =
            load_beside(file_with(kFile, {{"scale", scale}}, {{"light", 0}}), ies_text({}));
        EXPECT_EQ(scene.lights[0].direction, glm::dvec3(0.0)) << scale;
        EXPECT_EQ(scene.lights, scene.lights) << scale;  // nothing is NaN
    }
}

TEST(LoadSceneProfiles, WhatIsWrongIsNamed) {
    const json use = {{"light", 0}};
    const std::string good = ies_text({});
    const auto expect = [&](const json& light, const json& node, const std::string& ies,
                            const std::string& message) {
        const std::string error = error_beside(light, node, ies);
        EXPECT_TRUE(contains(error, "scene.gltf: " + message)) << error;
        EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    };
    expect(kFile, use, "nothing", "extensions.EXT_lights_ies.lights[0] 'lamp.ies': line 1: there");
    expect(kFile, {{"light", 1}}, good,
           "nodes[1].extensions.EXT_lights_ies.light is 1, must be an index into the 1 lights");
    expect(kFile, {{"multiplier", 1}}, good, "nodes[1].extensions.EXT_lights_ies.light is missing");
    expect(json::object(), use, good, "extensions.EXT_lights_ies.lights[0]: must have either");
    expect({{"uri", "lamp.ies"}, {"bufferView", 0}}, use, good,
           "extensions.EXT_lights_ies.lights[0]: must have either");
    expect({{"bufferView", 0}}, use, good,
           "extensions.EXT_lights_ies.lights[0]: has a bufferView but no mimeType");
    expect({{"bufferView", 0}, {"mimeType", "text/plain"}}, use, good,
           "extensions.EXT_lights_ies.lights[0].mimeType is \"text/plain\"");
    expect({{"uri", "missing.ies"}}, use, good, "extensions.EXT_lights_ies.lights[0]");
}

TEST(LoadSceneProfiles, AnglesThatTablesCannotHoldAreStated) {
    IesText fine{.vertical = {0, 1.0 / 3.0, 0.34, 90}};
    fine.candela = [](double v, double) { return v == 0.34 ? 100.0 : 0.0; };
    testing::internal::CaptureStderr();
    load_beside(file_with(kFile, json::object(), {{"light", 0}}), ies_text(fine));
    const std::string warning = testing::internal::GetCapturedStderr();
    EXPECT_TRUE(contains(warning, "its angles are finer than 0.1 x 0.5 degrees")) << warning;
}

}  // namespace
}  // namespace kilolux
