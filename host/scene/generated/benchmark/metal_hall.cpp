// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/benchmark/metal_hall.h"

#include "host/scene/generated/benchmark/parts.h"
#include "host/scene/generated/small.h"

namespace kilolux {
namespace {

int add_metal(Scene& scene, const char* name, const glm::vec3& color, float roughness) {
    const int material = add_diffuse(scene, name, color);
    scene.materials.back().metallic = 1.0f;
    scene.materials.back().roughness = roughness;
    return material;
}

// The inside of a box.
MeshBuilder hall_inside(const glm::dvec3& a, const glm::dvec3& b) {
    MeshBuilder out;
    out.level({a.x, a.z}, {b.x, b.z}, a.y, 1.0);
    out.level({a.x, a.z}, {b.x, b.z}, b.y, -1.0);
    out.wall({a.x, a.y}, {b.x, b.y}, a.z, 1.0);
    out.wall({a.x, a.y}, {b.x, b.y}, b.z, -1.0);
    for (const auto& [x, facing] : {std::pair{a.x, 1.0}, std::pair{b.x, -1.0}}) {
        out.quad({x, a.y, a.z}, {x, a.y, b.z}, {x, b.y, b.z}, {x, b.y, a.z}, {facing, 0, 0});
    }
    return out;
}

}  // namespace

Scene make_metal_hall() {
    constexpr glm::dvec3 kLow(-6.0, 0.0, -12.0), kHigh(6.0, 6.0, 12.0);
    Scene scene;
    scene.name = "metal_hall";
    const int walls = add_metal(scene, "aluminium", {0.91f, 0.92f, 0.92f}, 0.6f);
    const int pillars = add_metal(scene, "iron", {0.56f, 0.57f, 0.58f}, 0.45f);
    const int balls[] = {add_metal(scene, "gold", {1.0f, 0.77f, 0.34f}, 0.4f),
                         add_metal(scene, "copper", {0.96f, 0.64f, 0.54f}, 0.5f),
                         add_metal(scene, "brass", {0.91f, 0.78f, 0.42f}, 0.7f)};
    place(scene, add_bare(scene, "hall", hall_inside(kLow, kHigh), walls));
    MeshBuilder pillar;
    pillar.lathe({{Point2(0.4, 0.0), Point2(0.4, kHigh.y)}, 0.6}, 32);
    const int pillar_mesh = add_bare(scene, "pillar", pillar, pillars);
    for (int i = 0; i < 10; ++i) {
        place(scene, pillar_mesh, placed({i % 2 == 0 ? -3.6 : 3.6, 0.0, 4.4 * (i / 2) - 8.8}));
    }
    for (int i = 0; i < 3; ++i) {
        const int mesh = add_bare(scene, "ball", ball(0.9, 48), balls[i]);
        for (int k = 0; k < 3; ++k) {
            place(scene, mesh, placed({1.4 * ((i + k) % 3 - 1), 0.9, 3.0 * (3 * k + i) - 11.0}));
        }
    }
    scene.cameras = {camera_from_to("along", {-4.6, 1.8, 11.0}, {1.2, 1.6, -4.0}, 55.0),
                     camera_from_to("above", {0.5, 5.2, -11.4}, {0.0, 0.5, 3.0}, 60.0)};
    scene.light_box = {{-5.6, 0.3, -11.6}, {5.6, 5.7, 11.6}};
    return scene;
}

}  // namespace kilolux
