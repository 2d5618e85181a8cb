// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/small.h"

#include <array>
#include <cmath>
#include <numbers>

#include "host/scene/camera.h"
#include "host/scene/lights/light_generator_hash.h"

namespace kilolux {
namespace {

// A mesh of positions and normals alone.
int add_bare(Scene& scene, const char* name, const MeshBuilder& builder, int material) {
    Mesh mesh = builder.build(name, material, 1.0, false);
    mesh.texcoords[0].clear();
    return add_mesh(scene, std::move(mesh));
}

}  // namespace

int add_diffuse(Scene& scene, const char* name, const glm::vec3& color) {
    Material& material = scene.materials.emplace_back();
    material.name = name;
    material.base_color = glm::vec4(color, 1.0f);
    material.metallic = 0.0f;
    return static_cast<int>(scene.materials.size()) - 1;
}

MeshBuilder ball(double radius, int segments) {
    MeshBuilder builder;
    builder.patch(segments, segments / 2, [=](double u, double v) {
        const double around = 2.0 * std::numbers::pi * u;
        const double down = std::numbers::pi * v;
        const glm::dvec3 n(std::sin(down) * std::cos(around), std::cos(down),
                           -std::sin(down) * std::sin(around));
        return SurfacePoint{radius * n, n, {u, v}};
    });
    return builder;
}

SceneCamera camera_from_to(const char* name, const glm::dvec3& from, const glm::dvec3& to,
                           double y_fov_deg) {
    return scene_camera_of(look_at(from, to, {0, 1, 0}, glm::radians(y_fov_deg)), name);
}

Scene make_plain(std::uint64_t seed) {
    Scene scene;
    scene.name = "plain";
    MeshBuilder floor;
    floor.level({-6, -6}, {6, 6}, 0);
    place(scene, add_bare(scene, "floor", floor, add_diffuse(scene, "grey", glm::vec3(0.5f))));
    constexpr std::array<glm::vec3, 3> kColors = {
        {{0.8f, 0.2f, 0.15f}, {0.2f, 0.6f, 0.25f}, {0.75f, 0.75f, 0.7f}}};
    std::array<int, 3> balls{};
    for (std::size_t i = 0; i < kColors.size(); ++i) {
        balls[i] = add_bare(scene, "ball", ball(0.8, 24), add_diffuse(scene, "paint", kColors[i]));
    }
    for (int i = 0; i < 9; ++i) {
        const std::uint64_t bits = item_bits(item_key(seed, static_cast<std::uint64_t>(i)), 0);
        const glm::dvec3 at(3.0 * (i % 3 - 1), 0.8 + unit_double(bits), 3.0 * (i / 3 - 1));
        place(scene, balls[static_cast<std::size_t>(i % 3)], placed(at));
    }
    scene.cameras = {camera_from_to("front", {4.0, 4.5, 10.0}, {0.0, 0.8, 0.0}, 45.0)};
    scene.light_box = {{-6.0, 0.2, -6.0}, {6.0, 4.0, 6.0}};
    return scene;
}

Scene make_corridor(std::uint64_t) {
    constexpr double kLength = 500.0;
    constexpr double kHalfWidth = 3.0;
    constexpr double kHeight = 4.0;
    Scene scene;
    scene.name = "corridor";
    const int stone = add_diffuse(scene, "stone", {0.55f, 0.52f, 0.48f});
    const int plaster = add_diffuse(scene, "plaster", {0.7f, 0.66f, 0.6f});
    MeshBuilder hall;
    for (const double side : {-1.0, 1.0}) {
        const double x = side * kHalfWidth;
        hall.quad({x, 0, 0}, {x, 0, -kLength}, {x, kHeight, -kLength}, {x, kHeight, 0},
                  {-side, 0, 0});
        const double y = side > 0.0 ? kHeight : 0.0;
        hall.level({-kHalfWidth, 0}, {kHalfWidth, -kLength}, y, -side);
    }
    hall.wall({-kHalfWidth, 0}, {kHalfWidth, kHeight}, -kLength, 1);
    place(scene, add_bare(scene, "hall", hall, plaster));
    MeshBuilder pillars;
    for (const double side : {-1.0, 1.0}) {
        pillars.box({side * 2.6 - 0.3, 0.0, -0.3}, {side * 2.6 + 0.3, kHeight, 0.3});
    }
    const int mesh = add_bare(scene, "pillars", pillars, stone);
    for (double z = 5.0; z < kLength; z += 10.0) place(scene, mesh, placed({0.0, 0.0, -z}));
    scene.cameras = {camera_from_to("along", {0.4, 1.7, -0.5}, {0.0, 1.6, -kLength}, 50.0),
                     camera_from_to("back", {-1.0, 1.7, -kLength + 1.0}, {0.5, 1.6, 0.0}, 50.0)};
    scene.light_box = {{-2.9, 0.2, -kLength}, {2.9, 3.8, 0.0}};
    return scene;
}

}  // namespace kilolux
