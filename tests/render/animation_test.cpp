// SPDX-License-Identifier: Apache-2.0
// A renderer shows what moved in its scene: the picture is that of a renderer made for it.
#include <cctype>
#include <map>

#include "host/base/error.h"
#include "host/scene/animated_scene.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

using nlohmann::json;

// How vertex 3 of file_with_flap() comes to vertex 1, which leaves the second triangle no area.
enum class FoldedBy { morph_target, bone };

// Two triangles with normals and a normal map, whose texture coordinates mirror each other and
// which share two vertices; a larger triangle behind; a lamp. `folded`, 0 or 1, is what a clip
// gives at second 0, where it goes to 0 until second 1; without the clip it stays.
GltfBuilder file_with_flap(FoldedBy by, float folded, bool moves) {
    GltfBuilder file = quad_with_normal_map();
    json& primitive = file.primitive();
    primitive["attributes"] = {
        {"POSITION", file.add_floats("VEC3", {-1, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 0})},
        {"NORMAL", file.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1})},
        {"TEXCOORD_0", file.add_floats("VEC2", {1, 0, 0, 0, 0, 1, 1, 0})}};
    primitive["indices"] = file.add_indices({0, 1, 2, 1, 3, 2});
    json channel = {{"sampler", 0}};
    std::vector<float> values = {folded, 0};
    if (by == FoldedBy::morph_target) {
        primitive["targets"] = {
            {{"POSITION", file.add_floats("VEC3", {0, 0, 0, 0, 0, 0, 0, 0, 0, -1, 0, 0})}}};
        file.root["meshes"][0]["weights"] = {folded};
        channel["target"] = {{"node", 0}, {"path", "weights"}};
    } else {
        const Blob joints = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0};
        json& attributes = primitive["attributes"];
        attributes["JOINTS_0"] = file.add_accessor(joints, {kUnsignedByte, "VEC4", 4, false, 0});
        attributes["WEIGHTS_0"] =
            file.add_floats("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
        const float scale = 1.0f - folded;
        const int still = file.add_node({{"name", "still"}});
        const int bone = file.add_node({{"scale", {scale, scale, scale}}});
        file.add("skins", {{"joints", {still, bone}}});
        file.root["nodes"][0]["skin"] = 0;
        channel["target"] = {{"node", bone}, {"path", "scale"}};
        values = {scale, scale, scale, 1, 1, 1};
    }
    const int behind = file.add("meshes", triangle_file().root["meshes"][0]);
    json& attributes = file.primitive(static_cast<std::size_t>(behind))["attributes"];
    attributes = {{"POSITION", file.add_floats("VEC3", {-3, -2, -1, 3, -2, -1, 0, 4, -1})},
                  {"NORMAL", file.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1})}};
    file.add_node({{"mesh", behind}});
    file.root["extensionsUsed"] = {"KHR_lights_punctual"};
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 20}, {"range", 20}}};
    file.add_node(
        {{"translation", {1, 1, 2}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    if (!moves) return file;
    const int times = file.add_floats("SCALAR", {0, 1});
    const int output = file.add_floats(by == FoldedBy::bone ? "VEC3" : "SCALAR", values);
    file.add("animations",
             {{"samplers", {{{"input", times}, {"output", output}}}}, {"channels", {channel}}});
    return file;
}

// A clip that takes a triangle's area away, and gives it back, shows what the poses show as files.
TEST(Animation, TrianglesWithoutAreaAtFirstBecomeWhatAStillFileShows) {
    const TempFolder folder;
    const auto path = folder.path() / "flap.glb";
    for (const FoldedBy by : {FoldedBy::morph_target, FoldedBy::bone}) {
        write_file(path, file_with_flap(by, 1.0f, true).glb());
        AnimatedScene moving(path, {});
        const Scene open = load(file_with_flap(by, 0.0f, false));
        const Scene folded = load(file_with_flap(by, 1.0f, false));
        EXPECT_EQ(open.meshes[0].positions.size(), 6u) << "vertices split at mirrored halves";
        const Camera camera = frame_box(bounds(open));
        for (const RendererKind kind : {RendererKind::deferred, RendererKind::forward}) {
            RenderSettings settings = small_settings(64, 48, 0);
            settings.renderer = kind;
            Renderer renderer(moving.scene(), settings);
            const auto at_once = [&](const Scene& scene) {
                return Renderer(scene, settings).render(camera, 0.0).radiance;
            };
            EXPECT_NE(at_once(open), at_once(folded));
            for (const double time : {0.0, 1.0, 0.0}) {
                moving.set_time(time);
                EXPECT_EQ(renderer.render(camera, time).radiance,
                          at_once(time == 1.0 ? open : folded))
                    << static_cast<int>(by) << " at " << time;
            }
        }
    }
}

// A masked quad with maps before a triangle, and a lamp. What no surface shows at second 0 a clip
// gives it until second 1: emission, metal, a specular colour, a texture transform, and holes.
GltfBuilder file_with_changing_material(double second) {
    GltfBuilder file = file_with_flap(FoldedBy::morph_target, 0.0f, false);
    const Blob checks = {255, 255, 255, 255, 99, 99, 99, 0, 99, 99, 255, 255, 255, 255, 99, 0};
    const int texture = file.add_texture(encode_image("png", 2, 4, checks), "image/png");
    json& material = file.root["materials"][0];
    const json moved = {{"KHR_texture_transform", {{"offset", {0, 0}}}}};
    const float share = static_cast<float>(second);
    material = {{"normalTexture", material["normalTexture"]},
                {"alphaMode", "MASK"},
                {"alphaCutoff", 0.75f * share},
                {"emissiveFactor", {0.5 * second, second, 0}},
                {"pbrMetallicRoughness",
                 {{"metallicFactor", second},
                  {"roughnessFactor", 0.5},
                  {"baseColorTexture", {{"index", texture}, {"extensions", moved}}}}},
                {"extensions",
                 {{"KHR_materials_specular", {{"specularColorFactor", {1, 1 - second, 1}}}}}}};
    const std::string offset =
        "/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/offset";
    material[json::json_pointer(offset)] = {0.25 * second, 0};
    return file;
}

// The same, as a clip.
GltfBuilder file_with_material_clip() {
    const json first = file_with_changing_material(0.0).root["materials"][0].flatten();
    const json last = file_with_changing_material(1.0).root["materials"][0].flatten();
    GltfBuilder file = file_with_changing_material(0.0);
    const int times = file.add_floats("SCALAR", {0, 1});
    std::map<std::string, std::pair<std::vector<float>, std::vector<float>>> driven;
    for (const auto& [path, value] : last.items()) {
        if (!value.is_number() || path.ends_with("index")) continue;
        const bool is_in_array = std::isdigit(static_cast<unsigned char>(path.back())) != 0;
        auto& [from, to] = driven[is_in_array ? path.substr(0, path.rfind('/')) : path];
        from.push_back(first.at(path));
        to.push_back(value);
    }
    json clip;
    for (const auto& [path, keys] : driven) {
        std::vector<float> values = keys.first;
        values.insert(values.end(), keys.second.begin(), keys.second.end());
        const char* const types[] = {"", "SCALAR", "VEC2", "VEC3"};
        const int output = file.add_floats(types[keys.first.size()], values);
        clip["samplers"].push_back({{"input", times}, {"output", output}});
        const json extension = {{"KHR_animation_pointer", {{"pointer", "/materials/0" + path}}}};
        clip["channels"].push_back({{"sampler", clip["samplers"].size() - 1},
                                    {"target", {{"path", "pointer"}, {"extensions", extension}}}});
    }
    file.add("animations", clip);
    return file;
}

// A renderer that was made where the material had nothing shows all that it has later.
TEST(Animation, MaterialsThatAClipDrivesReachEveryRenderer) {
    const TempFolder folder;
    const auto path = folder.path() / "clip.glb";
    write_file(path, file_with_material_clip().glb());
    AnimatedScene moving(path, {});
    const Scene stills[] = {load(file_with_changing_material(0.0)),
                            load(file_with_changing_material(1.0))};
    const Camera camera = frame_box(bounds(stills[0]));
    const struct {
        RendererKind renderer;
        Geometry geometry;
        Shadows shadows = Shadows::off;
    } cases[] = {{RendererKind::deferred, Geometry::compute, Shadows::exact},
                 {RendererKind::deferred, Geometry::ids},
                 {RendererKind::deferred, Geometry::planes},
                 {RendererKind::forward, Geometry::automatic},
                 {RendererKind::forward_plus, Geometry::automatic}};
    for (const auto& c : cases) {
        RenderSettings settings = small_settings(64, 48, 0);
        settings.renderer = c.renderer;
        settings.geometry = c.geometry;
        settings.shadows = c.shadows;
        moving.set_time(0.0);
        Renderer renderer(moving.scene(), settings);
        std::vector<float> radiance[2];
        for (const int second : {0, 1, 0}) {
            moving.set_time(second);
            radiance[second] = renderer.render(camera, 0.0).radiance;
            EXPECT_EQ(radiance[second],
                      Renderer(stills[second], settings).render(camera, 0.0).radiance)
                << static_cast<int>(c.renderer) << " " << static_cast<int>(c.geometry) << " at "
                << second;
        }
        EXPECT_NE(radiance[0], radiance[1]);
    }
}

// Node 0 is the quad with the normal map, the last one the only spot light.
GltfBuilder file_with_shown_nodes(bool visible, bool moves) {
    GltfBuilder file = file_with_flap(FoldedBy::morph_target, 0.0f, false);
    json& lights = file.root["extensions"]["KHR_lights_punctual"]["lights"];
    lights.push_back({{"type", "spot"}, {"intensity", 50}, {"range", 20}});
    const int lamp = file.add_node(
        {{"translation", {0, 0, 2}}, {"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
    const int times = file.add_floats("SCALAR", {0, 1});
    const int output = file.add_floats("SCALAR", {0, 1});
    json clip = {{"samplers", {{{"input", times}, {"output", output}, {"interpolation", "STEP"}}}}};
    for (const int node : {0, lamp}) {
        const std::string pointer =
            "/nodes/" + std::to_string(node) + "/extensions/KHR_node_visibility/visible";
        file.root[json::json_pointer(pointer)] = visible;
        const json extension = {{"KHR_animation_pointer", {{"pointer", pointer}}}};
        clip["channels"].push_back(
            {{"sampler", 0}, {"target", {{"path", "pointer"}, {"extensions", extension}}}});
    }
    if (moves) file.add("animations", clip);
    return file;
}

TEST(Animation, NodesThatAreHiddenAtFirstShowLater) {
    const TempFolder folder;
    const auto path = folder.path() / "shown.glb";
    write_file(path, file_with_shown_nodes(false, true).glb());
    AnimatedScene moving(path, {});
    const Scene stills[] = {load(file_with_shown_nodes(false, false)),
                            load(file_with_shown_nodes(true, false))};
    const Camera camera = frame_box(bounds(stills[1]));
    for (const RendererKind kind : {RendererKind::deferred, RendererKind::forward}) {
        RenderSettings settings = small_settings(64, 48, 0);
        settings.renderer = kind;
        if (kind == RendererKind::deferred) settings.shadows = Shadows::exact;
        moving.set_time(0.0);
        Renderer renderer(moving.scene(), settings);
        for (const int second : {0, 1, 0}) {
            moving.set_time(second);
            EXPECT_EQ(renderer.render(camera, 0.0).radiance,
                      Renderer(stills[second], settings).render(camera, 0.0).radiance)
                << static_cast<int>(kind) << " at " << second;
        }
    }
}

// Rows of vertices have the room that they began with.
TEST(Animation, RefusesAnotherNumberOfVertices) {
    for (const RendererKind kind : {RendererKind::deferred, RendererKind::forward}) {
        Scene scene = make_generated_scene("grid");
        RenderSettings settings = small_settings(32, 18, 10);
        settings.renderer = kind;
        const Camera camera = first_camera(scene);
        Renderer renderer(scene, settings);
        renderer.render(camera, 0.0);
        Mesh& mesh = scene.meshes.front();
        const std::size_t vertices = mesh.positions.size();
        mesh.positions.push_back(mesh.positions.front());
        ++mesh.revision;
        ++scene.revisions.geometry;
        try {
            renderer.render(camera, 0.0);
            ADD_FAILURE() << "renders vertices beyond their room";
        } catch (const Error& error) {
            EXPECT_EQ(error.what(), "scene 'grid': mesh 0 has " + std::to_string(vertices + 1) +
                                        " vertices now, " + std::to_string(vertices) +
                                        " when it was set up");
        }
    }
}

TEST(Animation, ARendererFollowsItsScene) {
    for (const RendererKind kind : {RendererKind::deferred, RendererKind::forward_plus}) {
        Scene scene = grid_with_every_light();
        RenderSettings settings = small_settings(80, 45, 50);
        settings.renderer = kind;
        const Camera camera = first_camera(scene);
        Renderer renderer(scene, settings);
        const Frame before = renderer.render(camera, 0.0);

        scene.instances.front().world_from_object[3].x += 1.5;
        for (SceneLight& light : scene.lights) light.position.y -= 0.5;
        Mesh& mesh = scene.meshes.back();
        for (glm::vec3& position : mesh.positions) position *= 1.5f;
        ++mesh.revision;
        scene.revisions = {1, 1, 1, 0};
        scene.light_box = resting_bounds(scene);
        const Frame moved = renderer.render(camera, 0.0);
        EXPECT_NE(moved.radiance, before.radiance);
        Renderer fresh(scene, settings);
        EXPECT_EQ(moved.radiance, fresh.render(camera, 0.0).radiance);
    }
}

}  // namespace
}  // namespace kilolux
