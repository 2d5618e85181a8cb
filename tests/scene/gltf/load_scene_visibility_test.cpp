// SPDX-License-Identifier: Apache-2.0
// KHR_node_visibility.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include "host/scene/gltf/load_scene.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/ies_text.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

using nlohmann::json;

json visibility(const json& visible) { return {{"KHR_node_visibility", {{"visible", visible}}}}; }

// Node 0: a triangle. Node 1 has one of its own, above 2, a lamp of both extensions and a camera,
// above 3, a triangle.
GltfBuilder nested_file() {
    GltfBuilder file = triangle_file();
    const std::string text = ies_text({});
    const int view = file.add_view(Blob(text.begin(), text.end()));
    file.root["extensions"] = {
        {"KHR_lights_punctual", {{"lights", {{{"type", "point"}}}}}},
        {"EXT_lights_ies",
         {{"lights", {{{"bufferView", view}, {"mimeType", "application/x-ies-lm-63"}}}}}}};
    file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}});
    file.add("meshes", file.root["meshes"][0]);
    file.add_node({{"mesh", 1}, {"children", {2}}});
    file.add("nodes",
             {{"camera", 0},
              {"children", {3}},
              {"extensions",
               {{"KHR_lights_punctual", {{"light", 0}}}, {"EXT_lights_ies", {{"light", 0}}}}}});
    file.add("nodes", {{"mesh", 1}, {"translation", {5, 0, 0}}});
    file.root["extensionsRequired"] = {"KHR_node_visibility"};
    return file;
}

// "meshes instances lights webs' lights cameras" of the file.
std::string counts(const GltfBuilder& file) {
    const Scene scene = load(file);
    EXPECT_EQ(scene_defect(scene), "");
    return fmt::format("{} {} {} {} {}", scene.meshes.size(), scene.instances.size(),
                       scene.lights.size(), scene.aimed_profiles.size(), scene.cameras.size());
}

TEST(LoadSceneVisibility, AHiddenNodeHidesItsSubtreeButNoCamera) {
    GltfBuilder file = nested_file();
    EXPECT_EQ(counts(file), "2 3 2 1 1");
    file.root["nodes"][3]["extensions"] = visibility(false);
    EXPECT_EQ(counts(file), "2 2 2 1 1");
    file.root["nodes"][1]["extensions"] = visibility(false);
    EXPECT_EQ(counts(file), "1 1 0 0 1");
    file.root["nodes"][3]["extensions"] = visibility(true);
    EXPECT_EQ(counts(file), "1 1 0 0 1") << "a visible node below a hidden one";
    for (const json& shown : {visibility(true), json{{"KHR_node_visibility", json::object()}}}) {
        file.root["nodes"][1]["extensions"] = shown;
        EXPECT_EQ(counts(file), "2 3 2 1 1");
    }
}

TEST(LoadSceneVisibility, AJointThatIsHiddenMovesItsSkin) {
    GltfBuilder file = triangle_file();
    file.primitive()["attributes"]["JOINTS_0"] =
        file.add_accessor(Blob(12), {kUnsignedByte, "VEC4", 3, false, 0});
    file.primitive()["attributes"]["WEIGHTS_0"] =
        file.add_floats("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    file.add("skins", {{"joints", {1}}});
    file.root["nodes"][0]["skin"] = 0;
    file.add_node({{"translation", {3, 0, 0}}, {"extensions", visibility(false)}});
    EXPECT_EQ(world_positions(load(file)).at(0), glm::dvec3(3, 0, 0));
}

TEST(LoadSceneVisibility, IsABoolean) {
    GltfBuilder file = nested_file();
    file.root["nodes"][2]["extensions"] = visibility(0);
    EXPECT_TRUE(contains(load_error(file), "nodes[2].extensions.KHR_node_visibility.visible is 0"))
        << load_error(file);
}

}  // namespace
}  // namespace kilolux
