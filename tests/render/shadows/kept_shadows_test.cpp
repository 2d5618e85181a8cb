// SPDX-License-Identifier: Apache-2.0
// Exact shadows of lights that stand still over surfaces that stand still are not cast again.
#include <algorithm>
#include <random>

#include "host/scene/lights/light_generator.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

RenderSettings kept_settings(std::uint64_t generated = 0) {
    RenderSettings settings = small_settings(96, 64, generated);
    settings.shadows = Shadows::exact;
    settings.want.shadow_counts = true;
    return settings;
}

// The grid scene with a directional light and `count` points of its own.
Scene scene_with_points(std::uint64_t count) {
    Scene scene = grid_with_every_light();
    LightOptions options;
    options.count = count;
    const std::vector<SceneLight> points = generate_lights(options, scene, 0.0);
    scene.lights.insert(scene.lights.end(), points.begin(), points.end());
    return scene;
}

class Mover {
 public:
    explicit Mover(Scene& scene) : scene_(scene), box_(bounds(scene)) {}

    // Moves `count` lights to other places, which changes the order of many.
    void move(int count) {
        for (int i = 0; i < count; ++i) any().position = place();
        ++scene_.revisions.lights;
    }

    SceneLight& any() { return scene_.lights[random() % scene_.lights.size()]; }
    std::uint32_t random() { return static_cast<std::uint32_t>(random_()); }

 private:
    glm::dvec3 place() {
        std::uniform_real_distribution<double> share(0.1, 0.9);
        return box_.min + box_.size() * glm::dvec3(share(random_), share(random_), share(random_));
    }

    Scene& scene_;
    Box box_;
    std::mt19937 random_{3};
};

Frame anew(const Scene& scene, const Camera& camera, RenderSettings settings, double time = 0.0) {
    settings.no_reuse = true;
    return Renderer(scene, settings).render(camera, time);
}

TEST(KeptShadows, OnlyRaysToLightsThatMovedAreCast) {
    Scene scene = scene_with_points(400);
    const Camera camera = first_camera(scene);
    const RenderSettings settings = kept_settings();
    Renderer renderer(scene, settings);
    const Frame first = renderer.render(camera, 0.0);
    ASSERT_GT(first.stats.shadows.rays, 1000u);
    Mover mover(scene);
    for (int i = 0; i < 3; ++i) {
        mover.move(4);  // one in a hundred
        const Frame frame = renderer.render(camera, 0.0);
        const Frame wanted = anew(scene, camera, settings);
        EXPECT_EQ(frame.radiance, wanted.radiance) << i;
        EXPECT_NE(frame.radiance, first.radiance) << i;
        EXPECT_GT(frame.stats.shadows.rays, 0u) << i;
        EXPECT_LT(frame.stats.shadows.rays, wanted.stats.shadows.rays / 25) << i;
        EXPECT_EQ(frame.stats.shadows.words, wanted.stats.shadows.words) << i;
    }
}

TEST(KeptShadows, ColoursCastNothing) {
    Scene scene = scene_with_points(100);
    const Camera camera = first_camera(scene);
    const RenderSettings settings = kept_settings();
    Renderer renderer(scene, settings);
    const Frame first = renderer.render(camera, 0.0);
    for (SceneLight& light : scene.lights) light.intensity *= 2.0f;
    ++scene.revisions.lights;
    const Frame frame = renderer.render(camera, 0.0);
    EXPECT_EQ(frame.stats.shadows.rays, 0u);
    EXPECT_NE(frame.radiance, first.radiance);
    EXPECT_EQ(frame.radiance, anew(scene, camera, settings).radiance);
}

TEST(KeptShadows, NothingIsKeptFromAnotherCamera) {
    Scene scene = scene_with_points(50);
    const RenderSettings settings = kept_settings();
    Renderer renderer(scene, settings);
    Camera camera = first_camera(scene);
    renderer.render(camera, 0.0);
    camera.position.x += 0.1;
    const Frame frame = renderer.render(camera, 0.0);
    const Frame wanted = anew(scene, camera, settings);
    EXPECT_EQ(frame.stats.shadows.rays, wanted.stats.shadows.rays);
    EXPECT_EQ(frame.radiance, wanted.radiance);
}

TEST(KeptShadows, NothingIsKeptFromAnotherGrid) {
    Scene scene = scene_with_points(100);
    const Camera camera = first_camera(scene);
    RenderSettings settings = kept_settings();
    Renderer renderer(scene, settings);
    renderer.render(camera, 0.0);
    Mover mover(scene);
    mover.move(1);
    renderer.render(camera, 0.0);
    settings.grid.slices_per_octave *= 2;
    renderer.change(settings);
    const Frame frame = renderer.render(camera, 0.0);
    const Frame wanted = anew(scene, camera, settings);
    EXPECT_EQ(frame.radiance, wanted.radiance);
    EXPECT_EQ(frame.stats.shadows.rays, wanted.stats.shadows.rays);
}

// A pane that blends, low over the whole floor.
void add_pane(Scene& scene) {
    const Box box = bounds(scene);
    const double y = glm::mix(box.min.y, box.max.y, 0.2);
    Material material;
    material.base_color.w = 0.7f;
    material.alpha_mode = AlphaMode::blend;
    scene.materials.push_back(material);
    Mesh mesh;
    for (const glm::dvec2 at :
         {glm::dvec2(box.min.x, box.min.z), glm::dvec2(box.min.x, box.max.z),
          glm::dvec2(box.max.x, box.max.z), glm::dvec2(box.max.x, box.min.z)}) {
        mesh.positions.emplace_back(at.x, y, at.y);
    }
    mesh.normals.assign(4, {0, 1, 0});
    mesh.indices = {0, 1, 2, 0, 2, 3};
    mesh.material = static_cast<int>(scene.materials.size()) - 1;
    scene.meshes.push_back(mesh);
    scene.instances.push_back({static_cast<int>(scene.meshes.size()) - 1, glm::dmat4(1.0)});
}

// Layers of surfaces that blend have shadows of their own.
TEST(KeptShadows, ThroughSurfacesThatBlend) {
    Scene scene = scene_with_points(40);
    add_pane(scene);
    const Camera camera = first_camera(scene);
    const RenderSettings settings = kept_settings();
    Renderer renderer(scene, settings);
    renderer.render(camera, 0.0);
    Mover mover(scene);
    const glm::dvec3 size = bounds(scene).size();
    for (int i = 0; i < 6; ++i) {
        if (i % 2 == 0) {
            mover.move(3);
        } else {  // their order stays
            for (SceneLight& light : scene.lights) {
                light.position.x += 0.1 * size.x;
                light.direction = glm::normalize(light.direction + glm::dvec3(0.3, 0.0, 0.2));
            }
            ++scene.revisions.lights;
        }
        const Frame frame = renderer.render(camera, 0.0);
        EXPECT_EQ(frame.stats.layers, 1u);
        EXPECT_EQ(frame.radiance, anew(scene, camera, settings).radiance) << i;
    }
}

// Generated lights that stand keep their shadows beside one of the scene's that moves.
TEST(KeptShadows, GeneratedLightsCountToo) {
    Scene scene = make_generated_scene("grid");
    LightOptions one;
    one.count = 1;
    scene.lights = generate_lights(one, scene, 0.0);
    scene.lights[0].range = 0.1f * static_cast<float>(glm::length(bounds(scene).size()));
    const Camera camera = first_camera(scene);
    const RenderSettings settings = kept_settings(200);
    Renderer renderer(scene, settings);
    renderer.render(camera, 0.0);
    Mover(scene).move(1);
    const Frame frame = renderer.render(camera, 0.0);
    const Frame wanted = anew(scene, camera, settings);
    EXPECT_EQ(frame.radiance, wanted.radiance);
    EXPECT_LT(frame.stats.shadows.rays, wanted.stats.shadows.rays / 25);
    const Frame later = renderer.render(camera, 0.5);
    EXPECT_EQ(later.radiance, anew(scene, camera, settings, 0.5).radiance);
}

// Words without room are made again, in a frame with all of its stages.
TEST(KeptShadows, MoreWordsThanEver) {
    Scene scene = scene_with_points(30);
    RenderSettings settings = kept_settings();
    settings.width = settings.height = 128;
    const Camera camera = first_camera(scene);
    Renderer renderer(scene, settings);
    const std::uint64_t few = renderer.render(camera, 0.0).stats.shadows.words;
    scene = scene_with_points(1500);
    const auto range = static_cast<float>(glm::length(bounds(scene).size()));
    for (SceneLight& light : scene.lights) light.range = range;
    ++scene.revisions.lights;
    const Frame frame = renderer.render(camera, 0.0);
    EXPECT_GT(frame.stats.shadows.words, std::max<std::uint64_t>(1u << 18, 2 * few));
    const Frame wanted = anew(scene, camera, settings);
    EXPECT_EQ(frame.radiance, wanted.radiance);
    for (const char* stage : {"cull_lights", "refine_lights", "cast_shadows", "shade"}) {
        const auto is_stage = [&](const StageTime& time) { return time.name == stage; };
        EXPECT_EQ(std::ranges::count_if(frame.stats.stages, is_stage), 1) << stage;
    }
}

// Lights that move, change, come and go beside generated ones; cameras and grids change, too.
TEST(KeptShadows, ChangeNoByteOfRandomEdits) {
    Scene scene = scene_with_points(60);
    RenderSettings settings = kept_settings(20);
    Camera camera = first_camera(scene);
    Renderer renderer(scene, settings);
    Mover mover(scene);
    double time = 0.0;
    std::uint64_t cast = 0, all = 0;
    for (int i = 0; i < 40; ++i) {
        switch (mover.random() % 8) {
            case 0:
                camera.position.x += 0.05;
                break;
            case 1:
                time += 0.2;
                break;
            case 2:
                mover.any().range *= mover.random() % 2 == 0 ? 0.8f : 1.4f;
                ++scene.revisions.lights;
                break;
            case 3:
                scene.lights.push_back(mover.any());
                mover.move(1);
                break;
            case 4:
                scene.lights.erase(scene.lights.begin());
                ++scene.revisions.lights;
                break;
            case 5:
                settings.grid.slices_per_octave = 4 << (mover.random() % 2);
                break;
            default:
                mover.move(2);
        }
        renderer.change(settings);
        const Frame frame = renderer.render(camera, time);
        const Frame wanted = anew(scene, camera, settings, time);
        ASSERT_EQ(frame.radiance, wanted.radiance) << "edit " << i;
        cast += frame.stats.shadows.rays;
        all += wanted.stats.shadows.rays;
    }
    EXPECT_LT(cast, all * 3 / 4);
}

}  // namespace
}  // namespace kilolux
