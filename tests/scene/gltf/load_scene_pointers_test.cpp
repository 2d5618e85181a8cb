// SPDX-License-Identifier: Apache-2.0
// KHR_animation_pointer: at each time the scene is that of a file with the values of that time.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "host/scene/animated_scene.h"
#include "host/scene/gltf/rules.h"
#include "tests/scene/export_scenes.h"
#include "tests/support/gltf_seeds.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

using nlohmann::json;
using namespace nlohmann::literals;

// every_feature_file() with a texture transform in every slot, and without animation.
GltfBuilder still_file() {
    GltfBuilder file = every_feature_file();
    file.root.erase("animations");
    json& material = file.root["materials"][0];
    const json flat = material.flatten();
    for (const auto& [path, value] : flat.items()) {
        const std::size_t end = path.rfind("/index");
        if (end == std::string::npos) continue;
        material[json::json_pointer(path.substr(0, end) + "/extensions/KHR_texture_transform")] = {
            {"offset", {0.25, 0.5}}, {"rotation", 0.25}, {"scale", {2, 2}}};
    }
    file.root["extensions"]["KHR_lights_punctual"]["lights"][1]["spot"]["innerConeAngle"] = 0.25;
    return file;
}

void write_glb(const std::filesystem::path& path, GltfBuilder file) {
    file.root["buffers"][0]["byteLength"] = file.bin.size();
    write_file(path, file.glb());
}

Scene loaded(const GltfBuilder& file, const LoadOptions& options = {}) {
    const TempFolder folder;
    write_glb(folder.path() / "scene.glb", file);
    return load_scene(folder.path() / "scene.glb", options);
}

struct Keys {
    std::vector<float> values;
    const char* interpolation = "LINEAR";
};

// Adds a clip in which a property goes through the values at seconds 0 and 1, of which each is an
// array of a type of accessors.
void animate(GltfBuilder& file, const std::string& pointer, const std::string& type,
             const Keys& keys) {
    const int input = file.add_floats("SCALAR", {0, 1});
    const int output = file.add_floats(type, keys.values);
    json& clip = file.root["animations"][0];
    clip["channels"].push_back(
        {{"sampler", clip["samplers"].size()},
         {"target",
          {{"path", "pointer"},
           {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}});
    clip["samplers"].push_back(
        {{"input", input}, {"output", output}, {"interpolation", keys.interpolation}});
}

// The JSON pointer of a rule's property in the file; empty for one that animations cannot drive.
std::string pointer_of(const GltfRule& rule, const json& root) {
    if (rule.kind != JsonKind::number && rule.kind != JsonKind::numbers) return "";
    const std::size_t end = rule.path.find("[].");
    if (end == std::string::npos) return "";
    std::string array = "/" + rule.path.substr(0, end), rest = "/" + rule.path.substr(end + 3);
    std::ranges::replace(array, '.', '/');
    std::ranges::replace(rest, '.', '/');
    const std::set<std::string> driven = {"/materials", "/cameras",
                                          "/extensions/KHR_lights_punctual/lights"};
    if (!driven.contains(array)) return "";
    const json& elements = root.at(json::json_pointer(array));
    for (std::size_t i = 0; i < elements.size(); ++i) {
        const std::string parent = rest.substr(0, rest.rfind('/'));
        if (parent.empty() || elements[i].contains(json::json_pointer(parent))) {
            return fmt::format("{}/{}{}", array, i, rest);
        }
    }
    return "";
}

TEST(LoadScenePointers, EveryNumberOfMaterialsLightsAndCamerasIsDriven) {
    const json root = still_file().root;
    std::size_t count = 0;
    for (const GltfRule& rule : gltf_rules()) {
        const std::string pointer = pointer_of(rule, root);
        if (pointer.empty()) continue;
        ++count;
        const std::size_t length = rule.kind == JsonKind::number ? 1 : rule.length;
        const char* const types[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
        std::vector<float> values(length, 0.25f), middle(length, 0.5f);
        values.insert(values.end(), length, 0.75f);
        // Beyond znear, and above a vacuum's.
        const double scale = pointer.ends_with("zfar") ? 64 : pointer.ends_with("ior") ? 4 : 1;
        for (float& value : values) value *= static_cast<float>(scale);
        GltfBuilder moving = still_file(), still = still_file();
        animate(moving, pointer, types[length], {values});
        still.root[json::json_pointer(pointer)] = length == 1 ? json(0.5 * scale) : json(middle);
        testing::internal::CaptureStderr();
        EXPECT_EQ(scene_difference(loaded(moving, {0.5}), loaded(still)), "") << pointer;
        const std::string said = testing::internal::GetCapturedStderr();
        // This one makes glass, which says what it lacks.
        const bool is_glass = pointer.ends_with("transmissionFactor");
        EXPECT_EQ(contains(said, "thick glass does not bend light"), is_glass) << said;
        EXPECT_TRUE(said.empty() || is_glass) << pointer << ": " << said;
        EXPECT_NE(scene_difference(loaded(moving, {0.0}), loaded(moving, {1.0})), "") << pointer;
    }
    EXPECT_GE(count, 40u);
}

TEST(LoadScenePointers, NodesAndMeshesMoveAsByTheirPaths) {
    struct {
        const char *path, *type;
        std::vector<float> values;
        json last;
    } const cases[] = {{"translation", "VEC3", {0, 0, 0, 2, 4, 6}, {2, 4, 6}},
                       {"rotation", "VEC4", {0, 0, 0, 1, 0, 0, 1, 0}, {0, 0, 1, 0}},
                       {"scale", "VEC3", {1, 1, 1, 3, 3, 3}, {3, 3, 3}},
                       {"weights", "SCALAR", {0.25f, 0.75f}, json::array({0.75})}};
    for (const auto& c : cases) {
        GltfBuilder moving = still_file(), still = still_file();
        const std::string node = c.path == std::string("weights") ? "/nodes/0/" : "/nodes/1/";
        animate(moving, node + c.path, c.type, {c.values});
        still.root[json::json_pointer(node + c.path)] = c.last;
        const Scene end = loaded(moving, {1.0});
        EXPECT_EQ(scene_difference(end, loaded(still)), "") << c.path;
        EXPECT_NE(scene_difference(end, loaded(moving, {0.0})), "") << c.path;
    }
    GltfBuilder moving = still_file(), still = still_file();
    animate(moving, "/meshes/0/weights", "SCALAR", {{0.25f, 0.75f}});
    const TempFolder folder;
    write_glb(folder.path() / "m.glb", moving);
    AnimatedScene scene(folder.path() / "m.glb", {});
    for (const double time : {0.0, 1.0}) {
        scene.set_time(time);
        still.root["meshes"][0]["weights"] = {0.25 + 0.5 * time};
        EXPECT_EQ(scene_difference(scene.scene(), loaded(still)), "") << time;
    }
}

// A node is hidden, and has a mesh, a light and a camera below it.
TEST(LoadScenePointers, VisibilityGoesByStepsWithTheSubtree) {
    GltfBuilder file = still_file();
    const json& nodes = file.root["nodes"];
    const auto hidden = std::ranges::find_if(nodes, [](const json& node) {
        return node.contains("/extensions/KHR_node_visibility"_json_pointer);
    });
    const auto node = hidden - nodes.begin();
    const std::string pointer =
        fmt::format("/nodes/{}/extensions/KHR_node_visibility/visible", node);
    GltfBuilder shown = file;
    shown.root[json::json_pointer(pointer)] = true;
    const Scene all = loaded(shown);
    ASSERT_GT(all.instances.size(), loaded(file).instances.size());
    animate(file, pointer, "SCALAR", {{0, 1}, "STEP"});
    const TempFolder folder;
    write_glb(folder.path() / "v.glb", file);
    AnimatedScene scene(folder.path() / "v.glb", {});
    for (const double time : {0.0, 1.0, 0.99}) {
        scene.set_time(time);
        if (time == 1.0) {
            EXPECT_EQ(scene_difference(scene.scene(), all), "");
            continue;
        }
        EXPECT_EQ(scene.scene().instances.size(), all.instances.size()) << "kept as points";
        EXPECT_EQ(bounds(scene.scene()), bounds(loaded(still_file())));
        EXPECT_EQ(scene.scene().lights.size(), all.lights.size());
        EXPECT_EQ(scene.scene().lights.back().intensity, glm::vec3(0.0f));
    }
    file.root["animations"][0]["samplers"][0]["interpolation"] = "LINEAR";
    EXPECT_TRUE(contains(message_of<Error>([&] { loaded(file); }),
                         "animations[0].channels[0]: interpolation must be STEP, since it drives"));
}

TEST(LoadScenePointers, OneWarningNamesWhatIsNotRead) {
    const std::vector<std::string> pointers = {
        "/materials/0/extensions/KHR_materials_iridescence/iridescenceFactor",
        "/materials/1/normalTexture/scale",  // it has no such texture
        "/materials/99/emissiveFactor",
        "/materials//emissiveFactor",
        "/nodes/99999999999999999999999/translation",
        "/nodes/00/translation",
        "/nodes/0/matrix",
        "/materials/0/doubleSided",
        "/asset",
        "",
        "/nodes/0"};
    for (std::size_t count = 1; count <= pointers.size(); ++count) {
        GltfBuilder file = still_file();
        for (std::size_t i = 0; i < count; ++i) {
            animate(file, pointers[i], "SCALAR", {{0, 1}});
        }
        const std::string expected =
            count == 1
                ? fmt::format("left out: animations of '{}'", pointers[0])
                : fmt::format("left out: animations of '{}', and {} more", pointers[0], count - 1);
        testing::internal::CaptureStderr();
        EXPECT_EQ(scene_difference(loaded(file, {0.5}), loaded(still_file())), "");
        const std::string said = testing::internal::GetCapturedStderr();
        EXPECT_TRUE(contains(said, expected + "\n")) << said;
        LoadOptions strict;
        strict.strict = true;
        EXPECT_TRUE(
            contains(message_of<Error>([&] { loaded(file, strict); }), "--strict: " + expected));
    }
}

TEST(LoadScenePointers, ATimeIsWhatLoadingThenGives) {
    GltfBuilder file = still_file();
    animate(file, "/materials/0/emissiveFactor", "VEC3", {{0, 0, 0, 1, 1, 1}});
    animate(file, "/cameras/0/perspective/yfov", "SCALAR", {{0.5f, 1}});
    animate(file, "/extensions/KHR_lights_punctual/lights/0/intensity", "SCALAR", {{1, 2}});
    const TempFolder folder;
    write_glb(folder.path() / "p.glb", file);
    AnimatedScene scene(folder.path() / "p.glb", {});
    EXPECT_TRUE(scene.moves());
    EXPECT_EQ(scene.scene().clips.at(0).channels, 3u);
    for (const double time : {0.5, 1.0, 0.25, 0.0}) {
        const SceneRevisions before = scene.scene().revisions;
        scene.set_time(time);
        const SceneRevisions& now = scene.scene().revisions;
        EXPECT_EQ(now, (SceneRevisions{0, 0, before.lights + 1, before.cameras + 1,
                                       before.materials + 1}));
        EXPECT_EQ(scene_difference(scene.scene(), load_scene(folder.path() / "p.glb", {time})), "");
    }
}

// By what renderers decide once: a cubic spline goes beyond its keys.
TEST(LoadScenePointers, ExtremesBoundWhatMaterialsBecome) {
    GltfBuilder file = still_file();
    EXPECT_TRUE(loaded(file).extremes.empty());
    animate(file, "/materials/0/emissiveFactor", "VEC3",
            {{0, 0, 0, 0, 0, 0, 1, 1, 1, -1, -1, -1, 0, 0, 0, 0, 0, 0}, "CUBICSPLINE"});
    animate(file, "/materials/0/pbrMetallicRoughness/metallicFactor", "SCALAR", {{1, 0}});
    const Scene scene = loaded(file);
    const std::size_t count = scene.materials.size();
    ASSERT_EQ(scene.extremes.size(), 2 * count);
    for (int i = 0; i <= 16; ++i) {
        const Material now = loaded(file, {i / 16.0}).materials[0];
        const Material &least = scene.extremes[0], &most = scene.extremes[count];
        EXPECT_TRUE(glm::all(glm::lessThanEqual(least.emissive, now.emissive))) << i;
        EXPECT_TRUE(glm::all(glm::lessThanEqual(now.emissive, most.emissive))) << i;
        EXPECT_LE(least.metallic, now.metallic) << i;
        EXPECT_LE(now.metallic, most.metallic) << i;
    }
    EXPECT_EQ(scene.extremes[0].metallic, 0.0f);
    EXPECT_EQ(scene.extremes[1], scene.materials[1]) << "which stays";
}

TEST(LoadScenePointers, ACameraThatBecomesInvalidIsRefusedThen) {
    GltfBuilder file = still_file();
    animate(file, "/cameras/0/perspective/yfov", "SCALAR", {{1, -1}});
    EXPECT_NO_THROW(loaded(file));
    EXPECT_TRUE(contains(message_of<Error>([&] { loaded(file, {1.0}); }),
                         "cameras[0].perspective.yfov: is -1, must be between 0 and pi"));
}

// Meshes have tangents at all times where a strength is above 0 at some time.
TEST(LoadScenePointers, AnisotropyThatComesHasTangentsBefore) {
    GltfBuilder file = still_file();
    json& material = file.root["materials"][0];
    material.erase("normalTexture");
    material["extensions"].erase("KHR_materials_clearcoat");
    material["extensions"]["KHR_materials_anisotropy"] = {{"anisotropyStrength", 0.0}};
    EXPECT_TRUE(loaded(file).meshes.at(0).tangents.empty());
    animate(file, "/materials/0/extensions/KHR_materials_anisotropy/anisotropyStrength", "SCALAR",
            {{0.0f, 1.0f}});
    for (const double time : {0.0, 1.0}) {
        const Scene scene = loaded(file, {time});
        EXPECT_EQ(scene.materials[0].anisotropy_strength, static_cast<float>(time));
        EXPECT_FALSE(scene.meshes.at(0).tangents.empty()) << time;
    }
}

}  // namespace
}  // namespace kilolux
