// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/benchmark/panel_wall.h"

#include "host/scene/generated/benchmark/parts.h"
#include "host/scene/generated/small.h"

namespace kilolux {
namespace {

constexpr std::uint64_t kPanelSeed = 5;
constexpr double kPanelWallZ = -10.0;  // [m]
constexpr double kFarWallZ = 6.0;      // [m]
constexpr int kPanelColumns = 12, kPanelRows = 8;
constexpr float kPanelWidth = 1.4f, kPanelHeight = 0.8f;  // [m]

void add_panels(Scene& scene) {
    for (int i = 0; i < kPanelColumns * kPanelRows; ++i) {
        const auto random = [i](std::uint64_t k) {
            return static_cast<float>(
                benchmark_random(kPanelSeed, static_cast<std::uint64_t>(i), k));
        };
        SceneLight& light = scene.lights.emplace_back();
        light.type = LightType::rectangle;
        light.position = {1.9 * (i % kPanelColumns - 0.5 * (kPanelColumns - 1)),
                          0.9 + 1.15 * (i / kPanelColumns), kPanelWallZ + 0.05};
        light.direction = {0, 0, 1};
        light.side = {1, 0, 0};
        light.width = kPanelWidth;
        light.height = kPanelHeight;
        // From red on the left to blue on the right, of random brightness.
        const float right = static_cast<float>(i % kPanelColumns) / (kPanelColumns - 1);
        light.intensity = (1.0f + 8.0f * random(0)) *
                          glm::vec3(1.0f - 0.9f * right, 0.25f + 0.3f * random(1), 0.1f + right);
        light.range = 20.0f;
    }
}

}  // namespace

Scene make_panel_wall() {
    Scene scene;
    scene.name = "panel_wall";
    const int stone = add_matte(scene, "stone", glm::vec3(0.5f));
    const int clay = add_matte(scene, "clay", {0.6f, 0.35f, 0.25f});
    const int paint = add_diffuse(scene, "paint", {0.2f, 0.35f, 0.5f});
    scene.materials.back().roughness = 0.6f;
    MeshBuilder wall, block;
    wall.level({-14.0, kPanelWallZ}, {14.0, kFarWallZ}, 0.0);
    wall.wall({-14.0, 0.0}, {14.0, 11.0}, kPanelWallZ, 1.0);
    wall.wall({-14.0, 0.0}, {14.0, 11.0}, kFarWallZ, -1.0);
    block.box({-0.7, 0.0, -0.7}, {0.7, 2.2, 0.7});
    place(scene, add_bare(scene, "room", wall, stone));
    const int blocks = add_bare(scene, "block", block, clay);
    const int balls = add_bare(scene, "ball", ball(1.0, 48), paint);
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 at(3.2 * i - 11.2, i % 2 == 0 ? 1.0 : 0.0, i % 3 * 3.0 - 3.0);
        place(scene, i % 2 == 0 ? balls : blocks, placed(at));
    }
    add_panels(scene);
    scene.cameras = {
        camera_from_to("from the wall", {6.0, 4.5, kPanelWallZ + 1.5}, {-1.5, 1.2, 0.0}, 60.0)};
    return scene;
}

}  // namespace kilolux
