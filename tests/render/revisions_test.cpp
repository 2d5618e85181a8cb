// SPDX-License-Identifier: Apache-2.0
// A renderer remakes only what depends on the changed part of the scene.
#include <algorithm>

#include "host/scene/animated_scene.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

using nlohmann::json;

RenderSettings settings_with_shadows() {
    RenderSettings settings = small_settings(96, 64, 40);
    settings.shadows = Shadows::exact;
    return settings;
}

// A triangle in front of a larger one, a lamp, and a camera that a clip moves.
GltfBuilder file_with_moving_camera() {
    GltfBuilder file = triangle_file();
    file.primitive()["material"] = file.add("materials", {{"doubleSided", true}});
    file.add_node({{"mesh", 0}, {"scale", {4, 4, 1}}, {"translation", {-1, -1, -1}}});
    file.root["extensionsUsed"] = {"KHR_lights_punctual"};
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 20}, {"range", 20}}};
    file.add_node({{"translation", {0.4, 0.4, 2}},
                   {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}});
    const int node = file.add_node({{"camera", 0}});
    const int times = file.add_floats("SCALAR", {0, 4});
    const int path = file.add_floats("VEC3", {0, 0, 4, 1, 1, 5});
    file.add(
        "animations",
        {{"samplers", {{{"input", times}, {"output", path}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", "translation"}}}}}}});
    return file;
}

TEST(Revisions, AClipOfTheCameraBuildsNoShadowsAndUploadsNoLights) {
    const TempFolder folder;
    write_file(folder.path() / "camera.glb", file_with_moving_camera().glb());
    AnimatedScene moving(folder.path() / "camera.glb", {});
    const Scene& scene = moving.scene();
    const RenderSettings settings = settings_with_shadows();
    Renderer renderer(scene, settings);
    const Frame first = renderer.render(first_camera(scene), 0.0);
    EXPECT_EQ(first.stats.shadow_scenes_built, 0u) << "the renderer built it";
    EXPECT_EQ(first.stats.lights_uploaded, 1u) << "the device makes the generated ones";
    Frame last = first;
    for (const double time : {0.5, 1.0, 2.5}) {
        moving.set_time(time);
        const Frame frame = renderer.render(first_camera(scene), time);
        EXPECT_EQ(frame.stats.shadow_scenes_built, 0u) << time;
        EXPECT_EQ(frame.stats.lights_uploaded, 0u) << time;
        EXPECT_NE(frame.radiance, last.radiance) << time;
        EXPECT_EQ(frame.radiance,
                  Renderer(scene, settings).render(first_camera(scene), time).radiance)
            << time;
        last = frame;
    }
    EXPECT_EQ(scene.revisions, (SceneRevisions{0, 0, 0, 3}));
}

struct Part {
    const char* name;
    std::uint32_t SceneRevisions::*revision;
    void (*change)(Scene&);
    std::uint64_t shadow_scenes_built;
    bool makes_surfaces;
    std::uint64_t lights_uploaded;
};

constexpr Part kParts[] = {
    {"geometry", &SceneRevisions::geometry,
     [](Scene& scene) {
         for (glm::vec3& p : scene.meshes[0].positions) p.x += 0.25f;
         ++scene.meshes[0].revision;
     },
     1, true, 0},
    {"placement", &SceneRevisions::placement,
     [](Scene& scene) { scene.instances[0].world_from_object[3].x += 0.25; }, 1, true, 0},
    {"lights", &SceneRevisions::lights, [](Scene& scene) { scene.lights[0].position.x += 0.25; }, 0,
     false, 1},
    {"cameras", &SceneRevisions::cameras,
     [](Scene& scene) { scene.cameras[0].world_from_camera[3].x += 0.25; }, 0, false, 0},
    {"materials", &SceneRevisions::materials,
     [](Scene& scene) { scene.materials[0].base_color.x *= 0.5f; }, 0, true, 0},
};

TEST(Revisions, EachMakesItsOwnPartAnew) {
    const TempFolder folder;
    write_file(folder.path() / "camera.glb", file_with_moving_camera().glb());
    const RenderSettings settings = settings_with_shadows();
    for (const Part& part : kParts) {
        Scene scene = load_scene(folder.path() / "camera.glb", {});
        const Camera camera = first_camera(scene);
        Renderer renderer(scene, settings);
        renderer.render(camera, 0.0);
        part.change(scene);
        ++(scene.revisions.*part.revision);
        const Frame frame = renderer.render(camera, 0.0);
        EXPECT_EQ(frame.stats.shadow_scenes_built, part.shadow_scenes_built) << part.name;
        EXPECT_EQ(frame.stats.lights_uploaded, part.lights_uploaded) << part.name;
        EXPECT_EQ(has_stage(frame, "resolve_surfaces"), part.makes_surfaces) << part.name;
        EXPECT_EQ(frame.radiance, Renderer(scene, settings).render(camera, 0.0).radiance)
            << part.name;
    }
}

}  // namespace
}  // namespace kilolux
