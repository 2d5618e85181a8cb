// SPDX-License-Identifier: Apache-2.0
// Scenes whose shadows are known to be hard, each before one light.
#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "tests/support/box_scene.h"

namespace kilolux {

/// A scene, a camera and one point light in it.
struct ShadowScenario {
    std::string name;
    Scene scene;
    Camera camera;
};

inline SceneLight lamp(const glm::dvec3& position, float range = 40.0f) {
    SceneLight light;
    light.position = position;
    light.intensity = {50.0f, 50.0f, 50.0f};
    light.range = range;
    return light;
}

inline void add_box(Scene& scene, const glm::dvec3& size, const glm::dvec3& center,
                    double turn_rad = 0.0) {
    Mesh mesh = box_mesh(size);
    mesh.material = 0;
    glm::dmat4 place(1.0);
    place[0] = {std::cos(turn_rad), 0.0, std::sin(turn_rad), 0.0};
    place[2] = {-std::sin(turn_rad), 0.0, std::cos(turn_rad), 0.0};
    place[3] = glm::dvec4(center, 1.0);
    scene.instances.push_back({static_cast<int>(scene.meshes.size()), place});
    scene.meshes.push_back(std::move(mesh));
}

/// A sphere of `rings` x 2 `rings` quads with normals, which shared corners make closed.
inline Mesh sphere_mesh(double radius, int rings) {
    Mesh mesh;
    const int columns = 2 * rings;
    for (int i = 0; i <= rings; ++i) {
        for (int j = 0; j < columns; ++j) {
            const double polar = std::numbers::pi * i / rings;
            const double around = 2.0 * std::numbers::pi * j / columns;
            const glm::dvec3 n(std::sin(polar) * std::cos(around), std::cos(polar),
                               std::sin(polar) * std::sin(around));
            mesh.positions.emplace_back(radius * n);
            mesh.normals.emplace_back(n);
        }
    }
    for (int i = 0; i < rings; ++i) {
        for (int j = 0; j < columns; ++j) {
            const auto a = static_cast<std::uint32_t>(i * columns + j);
            const auto b = static_cast<std::uint32_t>(i * columns + (j + 1) % columns);
            const auto down = static_cast<std::uint32_t>(columns);
            mesh.indices.insert(mesh.indices.end(), {a, b, a + down, b, b + down, a + down});
        }
    }
    mesh.material = 0;
    return mesh;
}

/// An empty room with one matt material.
inline Scene shadow_stage() {
    Scene scene;
    scene.name = "stage";
    Material material;
    material.metallic = 0.0f;
    material.double_sided = true;
    material.base_color = {0.8f, 0.8f, 0.8f, 1.0f};
    scene.materials.push_back(material);
    return scene;
}

/// A row of columns before a light.
inline ShadowScenario columns_scenario() {
    Scene scene = shadow_stage();
    add_box(scene, {30.0, 0.5, 30.0}, {0.0, -0.25, 0.0});
    for (int i = 0; i < 7; ++i) {
        add_box(scene, {0.6, 4.0, 0.6}, {2.0 * i - 6.0, 2.0, 0.0}, 0.15 * i);
    }
    scene.lights.push_back(lamp({0.5, 3.0, -5.0}));
    return {"columns", scene, look_at({1.0, 8.0, 14.0}, {0.0, 0.5, 2.0}, {0, 1, 0}, 0.8)};
}

/// A wall of one millimetre between a light and the floor, the gap below it closed by touching.
inline ShadowScenario thin_wall_scenario() {
    Scene scene = shadow_stage();
    add_box(scene, {20.0, 0.5, 20.0}, {0.0, -0.25, 0.0});
    add_box(scene, {20.0, 10.0, 0.001}, {0.0, 5.0, 0.0});
    scene.lights.push_back(lamp({0.3, 1.0, -0.25}));
    return {"thin wall", scene, look_at({0.0, 4.0, 9.0}, {0.0, 0.0, 2.0}, {0, 1, 0}, 0.9)};
}

/// A light one millimetre above a floor of many triangles: all of it is lit.
inline ShadowScenario grazing_scenario() {
    Scene scene = shadow_stage();
    Mesh floor;
    constexpr int kSide = 40;
    for (int i = 0; i <= kSide; ++i) {
        for (int j = 0; j <= kSide; ++j) {
            // Uneven, so that no coordinate is round.
            floor.positions.emplace_back(0.37 * i - 7.4, 0.1, 0.41 * j - 8.2);
            floor.normals.emplace_back(0.0f, 1.0f, 0.0f);
        }
    }
    for (int i = 0; i < kSide; ++i) {
        for (int j = 0; j < kSide; ++j) {
            const auto a = static_cast<std::uint32_t>(i * (kSide + 1) + j);
            const auto b = a + kSide + 1;
            floor.indices.insert(floor.indices.end(), {a, a + 1, b, b, a + 1, b + 1});
        }
    }
    floor.material = 0;
    scene.meshes.push_back(floor);
    // Turned, so that its corners round.
    glm::dmat4 place(1.0);
    place[0] = {std::cos(0.3), std::sin(0.3), 0.0, 0.0};
    place[1] = {-std::sin(0.3), std::cos(0.3), 0.0, 0.0};
    scene.instances.push_back({0, place});
    const glm::dvec3 above = glm::dvec3(place * glm::dvec4(0.3, 0.101, 0.2, 1.0));
    scene.lights.push_back(lamp(above));
    return {"grazing", scene, look_at({-3.0, 9.0, 9.0}, {0.0, 0.0, 0.0}, {0, 1, 0}, 0.9)};
}

/// Spheres over a floor, coarse and fine, and a light among them.
inline ShadowScenario spheres_scenario() {
    Scene scene = shadow_stage();
    add_box(scene, {20.0, 0.5, 20.0}, {0.0, -0.25, 0.0});
    for (int i = 0; i < 3; ++i) {
        glm::dmat4 place(1.0);
        place[3] = {3.0 * i - 3.0, 1.1, 0.5 * i, 1.0};
        scene.instances.push_back({static_cast<int>(scene.meshes.size()), place});
        scene.meshes.push_back(sphere_mesh(1.0, 6 << (2 * i)));
    }
    scene.lights.push_back(lamp({-1.0, 4.0, -3.0}));
    return {"spheres", scene, look_at({1.0, 5.0, 9.0}, {0.0, 0.8, 0.0}, {0, 1, 0}, 0.8)};
}

/// The same, moved as a whole.
inline ShadowScenario moved(ShadowScenario from, const glm::dvec3& by) {
    for (Instance& instance : from.scene.instances) {
        instance.world_from_object[3] += glm::dvec4(by, 0.0);
    }
    for (SceneLight& light : from.scene.lights) light.position += by;
    from.camera.position += by;
    from.name += " far away";
    return from;
}

}  // namespace kilolux
