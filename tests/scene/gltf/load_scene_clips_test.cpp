// SPDX-License-Identifier: Apache-2.0
// Which animations of a file play.
#include <gtest/gtest.h>

#include "host/base/error.h"
#include "host/scene/gltf/load_scene.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

using nlohmann::json;

// An animation that moves nodes by (x, y, 0) within `length` seconds, by their translation.
json moving(GltfBuilder& file, const char* name, const std::vector<int>& nodes, float length,
            float x, float y) {
    const int input = file.add_floats("SCALAR", {0, length});
    const int output = file.add_floats("VEC3", {0, 0, 0, x, y, 0});
    json animation = {{"name", name}, {"samplers", {{{"input", input}, {"output", output}}}}};
    for (const int node : nodes) {
        animation["channels"].push_back(
            {{"sampler", 0}, {"target", {{"node", node}, {"path", "translation"}}}});
    }
    return animation;
}

// Two triangles: "walk" and "run" both move the first, "run" and "wave" the second.
GltfBuilder clips_file() {
    GltfBuilder file = triangle_file();
    file.root["nodes"][0]["name"] = "hip";
    file.add_node({{"mesh", 0}});
    file.add("animations", moving(file, "walk", {0}, 1, 1, 0));
    file.add("animations", moving(file, "run", {0, 1}, 2, 0, 8));
    file.add("animations", moving(file, "wave", {1}, 4, 16, 0));
    return file;
}

LoadOptions playing(const std::vector<std::string>& clips) {
    LoadOptions options;
    options.time = 9.0;  // behind every clip's end
    options.clips = clips;
    return options;
}

// The first vertices of both triangles.
struct Places {
    glm::dvec3 first{0.0};
    glm::dvec3 second{0.0};
    bool operator==(const Places&) const = default;
};

Places places_with(const std::vector<std::string>& clips) {
    const Scene scene = load(clips_file(), playing(clips));
    return {world_positions(scene, 0).at(0), world_positions(scene, 1).at(0)};
}

TEST(LoadSceneClips, TheFirstPlaysUnlessOthersAreChosen) {
    EXPECT_EQ(places_with({}), (Places{{1, 0, 0}, {0, 0, 0}}));
    EXPECT_EQ(places_with({"walk"}), places_with({}));
    EXPECT_EQ(places_with({"run"}), (Places{{0, 8, 0}, {0, 8, 0}}));
    EXPECT_EQ(places_with({"2"}), (Places{{0, 0, 0}, {16, 0, 0}}));
    EXPECT_EQ(places_with({"wave", "walk"}), (Places{{1, 0, 0}, {16, 0, 0}}));
    EXPECT_EQ(places_with({"none"}), Places{});
}

TEST(LoadSceneClips, WhereSeveralDriveAPropertyTheOneNamedFirstCountsAndAWarningSaysSo) {
    testing::internal::CaptureStderr();
    EXPECT_EQ(places_with({"wave", "run"}), (Places{{0, 8, 0}, {16, 0, 0}}));
    const std::string once = testing::internal::GetCapturedStderr();
    EXPECT_TRUE(contains(once,
                         "clips 'wave' and 'run' both drive the translation of nodes[1]; "
                         "the clip named first counts\n"))
        << once;
    testing::internal::CaptureStderr();
    EXPECT_EQ(places_with({"all"}), (Places{{1, 0, 0}, {0, 8, 0}}));
    const std::string twice = testing::internal::GetCapturedStderr();
    EXPECT_TRUE(contains(twice,
                         "clips 'walk' and 'run' both drive the translation of nodes[0] "
                         "'hip', and 1 more properties are driven twice"))
        << twice;
    testing::internal::CaptureStderr();
    places_with({"walk", "wave", "walk"});
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(LoadSceneClips, UnknownNamesAreRefusedWithTheNearest) {
    const auto message = [](const std::string& clip) {
        return message_of<UsageError>([&] { load(clips_file(), playing({clip})); });
    };
    EXPECT_TRUE(contains(message("wlak"), "--clip: 'wlak' is none of the animations of "));
    EXPECT_TRUE(contains(message("wlak"), "0 'walk', 1 'run', 2 'wave'; did you mean 'walk'?"));
    for (const char* odd : {"3", "-1", "", "1.0", "99999999999999999999"}) {
        EXPECT_TRUE(contains(message(odd), "is none of the animations")) << odd;
    }
    GltfBuilder twins = clips_file();
    twins.root["animations"][2]["name"] = "walk";
    const std::string text = message_of<UsageError>([&] { load(twins, playing({"walk"})); });
    EXPECT_TRUE(contains(text, "several animations of")) << text;
    EXPECT_EQ(load(twins, playing({"2"})).clips.at(2).plays, true);
    EXPECT_TRUE(contains(message_of<UsageError>([] { load(triangle_file(), playing({"x"})); }),
                         "scene.gltf: none"));
}

TEST(LoadSceneClips, ANameIsPreferredToAnIndex) {
    GltfBuilder file = clips_file();
    file.root["animations"][2]["name"] = "0";
    EXPECT_TRUE(load(file, playing({"0"})).clips.at(2).plays);
    EXPECT_FALSE(load(file, playing({"0"})).clips.at(0).plays);
}

TEST(LoadSceneClips, TheSceneListsThem) {
    GltfBuilder file = clips_file();
    file.root["animations"][1]["channels"][0]["target"].erase("node");
    const Scene scene = load(file, playing({"wave"}));
    ASSERT_EQ(scene.clips.size(), 3u);
    EXPECT_EQ(scene.clips[1].name, "run");
    EXPECT_EQ(scene.clips[1].length, 2.0);
    EXPECT_EQ(scene.clips[1].channels, 1u) << "the other one drives no node";
    EXPECT_EQ(scene.clips[2].length, 4.0);
    EXPECT_TRUE(scene.clips[2].plays);
    EXPECT_FALSE(scene.clips[0].plays);
}

// Morph weights of a clip that does not play do not make a shape of its own.
TEST(LoadSceneClips, WeightsOfOtherClipsDoNotCount) {
    GltfBuilder file = clips_file();
    file.primitive()["targets"] = {
        {{"POSITION", file.add_floats("VEC3", {0, 0, 8, 0, 0, 8, 0, 0, 8})}}};
    const int input = file.add_floats("SCALAR", {0, 1});
    const int output = file.add_floats("SCALAR", {0, 1});
    file.add("animations",
             {{"name", "swell"},
              {"samplers", {{{"input", input}, {"output", output}}}},
              {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}});
    EXPECT_EQ(load(file, playing({"walk"})).meshes.size(), 1u);
    const Scene swollen = load(file, playing({"swell"}));
    EXPECT_EQ(swollen.meshes.size(), 2u);
    EXPECT_EQ(world_positions(swollen, 0).at(0).z, 8.0);
}

}  // namespace
}  // namespace kilolux
