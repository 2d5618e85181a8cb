// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/small.h"

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "host/scene/camera.h"
#include "host/scene/generated/bake.h"
#include "host/scene/generated/noise.h"
#include "kernels/shared/hash.h"

namespace kilolux {
namespace {

// Textures of the grid, by their index in Scene::textures.
enum GridTexture { kChecker, kBumps, kMetalRoughness, kOcclusion, kHoles, kGlow };

Image painted(const char* name, int size, const std::function<glm::vec4(double, double)>& at) {
    Image image{name, size, size, {}};
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const glm::vec4 c = at((x + 0.5) / size, (y + 0.5) / size);
            for (int i = 0; i < 4; ++i) {
                image.rgba.push_back(static_cast<std::uint8_t>(std::lround(255.0f * c[i])));
            }
        }
    }
    return image;
}

bool checker(double u, double v, int cells) {
    return (static_cast<int>(u * cells) + static_cast<int>(v * cells)) % 2 == 0;
}

void add_textures(Scene& scene, std::uint32_t seed) {
    scene.images.push_back(painted("checker", 64, [](double u, double v) {
        return checker(u, v, 8) ? glm::vec4(0.9f, 0.85f, 0.75f, 1.0f)
                                : glm::vec4(0.25f, 0.35f, 0.5f, 1.0f);
    }));
    const auto bump = [seed](double u, double v) {
        return Texel{.height = 0.05 * fractal_noise({u, v}, 6, 3, seed)};
    };
    scene.images.push_back(
        bake({.name = "bumps", .size = 128, .metres = 1.0, .base_color = false, .normal = true},
             bump)
            .normal);
    scene.images.push_back(painted("metal-roughness", 64, [](double u, double v) {
        return glm::vec4(0.0f, static_cast<float>(0.1 + 0.8 * v), checker(u, v, 4) ? 1.0f : 0.0f,
                         1.0f);
    }));
    scene.images.push_back(painted("occlusion", 64, [](double u, double v) {
        const double x = std::abs(2.0 * u - 1.0) * std::abs(2.0 * v - 1.0);
        return glm::vec4(static_cast<float>(1.0 - 0.7 * x), 0.0f, 0.0f, 1.0f);
    }));
    scene.images.push_back(painted("holes", 64, [](double u, double v) {
        const glm::dvec2 p = glm::fract(glm::dvec2(u, v) * 4.0) - 0.5;
        return glm::vec4(0.8f, 0.7f, 0.3f, glm::length(p) < 0.33 ? 0.0f : 1.0f);
    }));
    scene.images.push_back(painted("glow", 64, [](double u, double v) {
        return glm::vec4(0.9f, 0.5f, 0.2f, 1.0f) * (checker(u, v, 6) ? 1.0f : 0.05f);
    }));
    for (int i = 0; i < 6; ++i) scene.textures.push_back({i, {}});
    scene.textures[kHoles].sampler = {Wrap::mirror,   Wrap::clamp, Filter::nearest,
                                      Filter::linear, false,       Filter::linear};
}

Material& add_material(Scene& scene, const char* name, const glm::vec3& color) {
    add_diffuse(scene, name, color);
    scene.materials.back().roughness = 0.6f;
    return scene.materials.back();
}

// One material per feature, in the order in which the objects stand; the first two are those of the
// floor and of the slabs.
void add_materials(Scene& scene) {
    add_material(scene, "textured", glm::vec3(1.0f)).base_color_texture.texture = kChecker;
    add_material(scene, "plain", {0.6f, 0.55f, 0.5f});
    add_material(scene, "normal-map", {0.7f, 0.4f, 0.3f}).normal_texture.texture = kBumps;
    Material& metal = add_material(scene, "metallic", {0.95f, 0.75f, 0.4f});
    metal.metallic = 1.0f;
    metal.roughness = 0.35f;
    Material& mixed = add_material(scene, "metal-roughness-map", {0.8f, 0.8f, 0.85f});
    mixed.metallic = mixed.roughness = 1.0f;
    mixed.metallic_roughness_texture.texture = kMetalRoughness;
    Material& glow = add_material(scene, "emissive", {0.1f, 0.1f, 0.1f});
    glow.emissive = {2.0f, 2.0f, 2.0f};  // brighter than white, as emissive strength allows
    glow.emissive_texture.texture = kGlow;
    add_material(scene, "occlusion", {0.8f, 0.8f, 0.8f}).occlusion_texture.texture = kOcclusion;
    Material& mask = add_material(scene, "alpha-mask", glm::vec3(1.0f));
    mask.base_color_texture.texture = kHoles;
    mask.alpha_mode = AlphaMode::mask;
    mask.double_sided = true;
    add_material(scene, "double-sided", {0.3f, 0.6f, 0.35f}).double_sided = true;
    add_material(scene, "vertex-colours", glm::vec3(1.0f));
    Material& second = add_material(scene, "second-uv-set", glm::vec3(1.0f));
    second.base_color_texture.texture = kChecker;
    second.base_color_texture.uv_set = 1;
    second.base_color_texture.uv_from_texcoord =
        glm::mat3(2.0f, 0.0f, 0.0f, 0.0f, 2.0f, 0.0f, 0.25f, 0.0f, 1.0f);
    add_material(scene, "unlit", {0.2f, 0.4f, 0.8f}).unlit = true;
    Material& coated = add_material(scene, "specular", {0.15f, 0.15f, 0.2f});
    coated.ior = 1.9f;
    coated.specular_color = {1.0f, 0.8f, 0.6f};
    coated.roughness = 0.2f;
}

Mesh thing(const Scene& scene, int material) {
    const std::string& name = scene.materials[static_cast<std::size_t>(material)].name;
    const bool bumpy = name == "normal-map";
    MeshBuilder builder;
    if (name == "alpha-mask" || name == "double-sided") {
        builder.patch(8, 8, [](double u, double v) {
            const glm::dvec3 p(1.4 * u - 0.7, 1.4 * v - 0.7, 0.2 * std::sin(6.0 * u));
            return SurfacePoint{p, {-1.2 / 1.4 * std::cos(6.0 * u), 0.0, 1.0}, {u, 1.0 - v}};
        });
    } else if (name == "textured" || name == "occlusion" || name == "emissive") {
        builder.box(glm::dvec3(-0.55), glm::dvec3(0.55));
    } else {
        builder = ball(0.7, 24);
    }
    Mesh mesh = builder.build(name, material, 1.0, bumpy);
    if (name == "vertex-colours") {
        for (const glm::vec3& p : mesh.positions) {
            mesh.colors.emplace_back(0.5f + 0.5f * p / 0.7f, 1.0f);
        }
    }
    if (name == "second-uv-set") {
        for (const glm::vec3& p : mesh.positions) mesh.texcoords[1].emplace_back(p.x, -p.y);
    }
    return mesh;
}

void add_things(Scene& scene) {
    int bumpy = 0;
    for (int i = 0; i < static_cast<int>(scene.materials.size()); ++i) {
        const glm::dvec3 at(2.2 * (i % 4) - 3.3, 0.8, 2.2 * (i / 4) - 3.3);
        const int mesh = add_mesh(scene, thing(scene, i));
        if (!scene.meshes.back().tangents.empty()) bumpy = mesh;
        place(scene, mesh, placed(at));
    }
    // The ball with the normal map again, mirrored: tests the tangents' handedness.
    glm::dmat4 mirrored = placed({5.4, 0.8, 1.0});
    mirrored[0] = -mirrored[0];
    place(scene, bumpy, mirrored);
    // And stretched unevenly: tests the transform of normals.
    glm::dmat4 stretched = placed({5.4, 1.0, -1.6}, 1);
    stretched[1] *= 1.3;
    stretched[2] *= 0.4;
    place(scene, bumpy, stretched);
}

void add_floor_and_slabs(Scene& scene) {
    MeshBuilder floor;
    floor.level({-7, -6}, {7, 6}, 0);
    place(scene, add_mesh(scene, floor.build("floor", 0, 0.25, false)));
    MeshBuilder slab;
    slab.box({-1.6, -0.06, -0.9}, {1.6, 0.06, 0.9});
    const int mesh = add_mesh(scene, slab.build("slab", 1, 1.0, false));
    for (int i = 0; i < 3; ++i) {
        const double tilt = 0.35 + 0.3 * i;
        glm::dmat4 tilted = placed({-5.2, 0.9 + 0.5 * i, 3.6 * (i - 1)}, i);
        tilted[0] = glm::dvec4(
            glm::dvec3(tilted[0]) * std::cos(tilt) + glm::dvec3(0, std::sin(tilt), 0), 0);
        tilted[1] = glm::dvec4(glm::cross(glm::dvec3(tilted[2]), glm::dvec3(tilted[0])), 0);
        place(scene, mesh, tilted);
    }
}

}  // namespace

int add_diffuse(Scene& scene, const char* name, const glm::vec3& color) {
    Material& material = scene.materials.emplace_back();
    material.name = name;
    material.base_color = glm::vec4(color, 1.0f);
    material.metallic = 0.0f;
    return static_cast<int>(scene.materials.size()) - 1;
}

int add_bare(Scene& scene, const char* name, const MeshBuilder& builder, int material) {
    Mesh mesh = builder.build(name, material, 1.0, false);
    mesh.texcoords[0].clear();
    return add_mesh(scene, std::move(mesh));
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

Scene make_grid(std::uint64_t seed) {
    Scene scene;
    scene.name = "grid";
    add_textures(scene, static_cast<std::uint32_t>(seed));
    add_materials(scene);
    add_floor_and_slabs(scene);
    add_things(scene);
    scene.cameras = {camera_from_to("front", {3.5, 5.5, 11.0}, {0.2, 0.6, 0.3}, 45.0),
                     camera_from_to("parallel", {6.0, 8.0, 12.0}, {0.0, 0.5, 0.0}, 45.0)};
    SceneCamera& parallel = scene.cameras.back();
    parallel.orthographic = true;
    parallel.y_extent = 6.0;
    parallel.z_near = 0.5;
    parallel.z_far = 40.0;
    scene.light_box = {{-6.5, 0.2, -5.5}, {6.5, 3.5, 5.5}};
    return scene;
}

}  // namespace kilolux
