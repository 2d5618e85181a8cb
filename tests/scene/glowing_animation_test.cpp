// SPDX-License-Identifier: Apache-2.0
// Lights of emissive surfaces that an animation moves, bends or dims.
#include <gtest/gtest.h>

#include <algorithm>

#include "host/scene/animated_scene.h"
#include "tests/scene/export_scenes.h"
#include "tests/support/gltf_builder.h"

namespace kilolux {
namespace {

using nlohmann::json;

json node_channel(int sampler, int node, const char* path) {
    return {{"sampler", sampler}, {"target", {{"node", node}, {"path", path}}}};
}

json emission_channel(int sampler, int material) {
    const std::string pointer = "/materials/" + std::to_string(material) + "/emissiveFactor";
    return {{"sampler", sampler},
            {"target",
             {{"path", "pointer"},
              {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}};
}

// Node 0: a triangle that stands still, of material 0; 1: one that moves, of material 0; 2: one
// that morphs, with a map; 3: a dark one that moves. In the last second material 0 goes out.
GltfBuilder glowing_file() {
    GltfBuilder file = triangle_file();
    file.root["extensionsUsed"] = {"KHR_animation_pointer"};
    json dark = file.root["meshes"][0];
    json morphing = dark;
    file.primitive()["material"] = 0;
    json& primitive = morphing["primitives"][0];
    primitive["material"] = 1;
    primitive["attributes"]["TEXCOORD_0"] = file.add_floats("VEC2", {0, 0, 1, 0, 0, 1});
    primitive["targets"] = {{{"POSITION", file.add_floats("VEC3", {0, 0, 0, 2, 0, 1, 0, 0, 0})}}};
    file.add("meshes", morphing);
    file.add("meshes", dark);
    file.add_node({{"mesh", 0}, {"translation", {3, 0, 0}}});
    file.add_node({{"mesh", 1}});
    file.add_node({{"mesh", 2}});
    const Blob pixels = {255, 0, 0, 0, 188, 10, 40, 50, 60, 255, 255, 255};
    const int texture = file.add_texture(encode_image("png", 2, 3, pixels), "image/png");
    file.add("materials", {{"emissiveFactor", {1, 0.5, 0.25}}});
    file.add("materials",
             {{"emissiveFactor", {1, 1, 1}}, {"emissiveTexture", {{"index", texture}}}});
    const int input = file.add_floats("SCALAR", {0, 1, 4});
    const int path = file.add_floats("VEC3", {3, 0, 0, 2, 1, 0, 2, 9, 0});
    const int weights = file.add_floats("SCALAR", {0, 1, 0.25f});
    const int emission = file.add_floats("VEC3", {1, 0.5f, 0.25f, 0.5f, 0.5f, 0.5f, 0, 0, 0});
    file.add("animations", {{"samplers",
                             {{{"input", input}, {"output", path}},
                              {{"input", input}, {"output", weights}},
                              {{"input", input}, {"output", emission}}}},
                            {"channels",
                             {node_channel(0, 1, "translation"), node_channel(1, 2, "weights"),
                              node_channel(0, 3, "translation"), emission_channel(2, 0)}}});
    return file;
}

std::vector<SceneLight> fresh_lights(const std::filesystem::path& path, double time) {
    LoadOptions options;
    options.time = time;
    AnimatedScene scene(path, options);
    scene.light_by_surfaces(true);
    return scene.scene().lights;
}

TEST(GlowingAnimation, IsWhatLoadingAtEachTimeGives) {
    const TempFolder folder;
    const auto path = folder.path() / "glow.gltf";
    write_file(path, glowing_file().gltf());
    AnimatedScene scene(path, {0.5});
    scene.light_by_surfaces(true);
    for (const double time : {0.5, 0.0, 1.0, 3.5, 4.0, 0.25, 99.0, 0.0}) {
        scene.set_time(time);
        EXPECT_EQ(scene.scene().lights, fresh_lights(path, time)) << time;
        EXPECT_EQ(scene.scene().lights.size(), 3u) << "kernels and indices are of their number";
        const auto dark =
            std::ranges::count(scene.scene().lights, glm::vec3(0.0f), &SceneLight::intensity);
        EXPECT_EQ(dark, time < 4.0 ? 0 : 2) << time;
        scene.light_by_surfaces(false);
        EXPECT_EQ(scene_difference(scene.scene(), load_scene(path, {time})), "") << time;
        scene.light_by_surfaces(true);
        EXPECT_EQ(scene.scene().lights, fresh_lights(path, time)) << time;
    }
    EXPECT_NE(fresh_lights(path, 0.5), fresh_lights(path, 1.0));
}

TEST(GlowingAnimation, LightsGrowWhereSurfacesThatGlowChange) {
    const struct {
        json channel;
        bool changes;
    } cases[] = {{node_channel(0, 1, "translation"), true},
                 {node_channel(1, 2, "weights"), true},
                 {node_channel(0, 3, "translation"), false},
                 {emission_channel(2, 0), true}};
    const TempFolder folder;
    const auto path = folder.path() / "glow.glb";
    for (const auto& [channel, changes] : cases) {
        GltfBuilder file = glowing_file();
        file.root["animations"][0]["channels"] = {channel};
        write_file(path, file.glb());
        AnimatedScene scene(path, {});
        scene.light_by_surfaces(true);
        const std::uint32_t before = scene.scene().revisions.lights;
        scene.set_time(1.0);
        EXPECT_EQ(scene.scene().revisions.lights, before + (changes ? 1 : 0)) << channel;
    }
}

TEST(GlowingAnimation, ThousandsOfTimesTakeNoMoreMemory) {
    const TempFolder folder;
    const auto path = folder.path() / "glow.glb";
    write_file(path, glowing_file().glb());
    LoadOptions options;
    options.max_memory_bytes = 200'000;
    AnimatedScene scene(path, options);
    scene.light_by_surfaces(true);
    for (int i = 1; i < 1000; ++i) scene.set_time(i / 1000.0);
    EXPECT_EQ(scene.scene().lights, fresh_lights(path, 0.999));
}

}  // namespace
}  // namespace kilolux
