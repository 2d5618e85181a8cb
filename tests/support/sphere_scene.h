// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>
#include <random>

#include "host/scene/scene.h"

namespace kilolux {

/// A sphere of radius 1 about the origin, of 48 rings and 96 columns, with texture coordinates and
/// tangents.
inline Scene sphere_scene(const Material& material) {
    constexpr std::uint32_t kRings = 48, kColumns = 96;
    Scene scene;
    Mesh mesh;
    for (std::uint32_t ring = 0; ring <= kRings; ++ring) {
        for (std::uint32_t column = 0; column <= kColumns; ++column) {
            const double from_top = std::numbers::pi * ring / kRings,
                         around = 2.0 * std::numbers::pi * column / kColumns;
            const glm::dvec3 p(std::sin(from_top) * std::sin(around), std::cos(from_top),
                               std::sin(from_top) * std::cos(around));
            mesh.positions.emplace_back(p);
            mesh.normals.emplace_back(p);
            mesh.tangents.emplace_back(std::cos(around), 0.0, -std::sin(around), 1.0);
            mesh.texcoords[0].emplace_back(4.0 * column / kColumns, 2.0 * ring / kRings);
        }
    }
    for (std::uint32_t ring = 0; ring < kRings; ++ring) {
        for (std::uint32_t column = 0; column < kColumns; ++column) {
            const std::uint32_t a = ring * (kColumns + 1) + column, b = a + kColumns + 1;
            for (const std::uint32_t i : {a, b, a + 1, a + 1, b, b + 1}) mesh.indices.push_back(i);
        }
    }
    mesh.material = 0;
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({0, glm::dmat4(1.0)});
    scene.materials.push_back(material);
    return scene;
}

/// A texture of one texel.
inline TextureUse add_texel(Scene& scene, const std::vector<std::uint8_t>& rgba) {
    scene.images.push_back({"texel", 1, 1, rgba});
    scene.textures.push_back({static_cast<int>(scene.images.size()) - 1, {}});
    TextureUse use;
    use.texture = static_cast<int>(scene.textures.size()) - 1;
    return use;
}

/// A texture of `size` x `size` random texels whose channels are at least `least`.
inline TextureUse add_noise(Scene& scene, int size, unsigned seed, std::array<unsigned, 3> least,
                            unsigned least_alpha = 255) {
    std::mt19937 random(seed);
    Image image{"noise", size, size, {}};
    for (int i = 0; i < 4 * size * size; ++i) {
        const unsigned from = i % 4 == 3 ? least_alpha : least[static_cast<std::size_t>(i % 4)];
        image.rgba.push_back(static_cast<std::uint8_t>(from + random() % (256u - from)));
    }
    scene.images.push_back(std::move(image));
    scene.textures.push_back({static_cast<int>(scene.images.size()) - 1, {}});
    TextureUse use;
    use.texture = static_cast<int>(scene.textures.size()) - 1;
    return use;
}

/// Car paint: rough metal with a normal map under a smooth coat with maps of its own.
inline Scene car_paint_scene() {
    Material m;
    m.base_color = {0.6f, 0.05f, 0.04f, 1.0f};
    m.metallic = 0.7f;
    m.roughness = 0.5f;
    m.normal_scale = 0.3f;
    m.emissive = {0.02f, 0.01f, 0.03f};
    m.clearcoat = 0.9f;
    m.clearcoat_roughness = 0.3f;
    m.clearcoat_normal_scale = 0.1f;
    Scene scene = sphere_scene(m);
    scene.materials[0].normal_texture = add_noise(scene, 32, 1, {0, 0, 192});
    scene.materials[0].clearcoat_texture = add_noise(scene, 16, 2, {128, 0, 0});
    scene.materials[0].clearcoat_roughness_texture = add_noise(scene, 16, 3, {0, 128, 0});
    scene.materials[0].clearcoat_normal_texture = add_noise(scene, 16, 4, {0, 0, 192});
    return scene;
}

/// Cloth with sheen of two maps.
inline Scene cloth_scene() {
    Material m;
    m.base_color = {0.3f, 0.1f, 0.5f, 1.0f};
    m.metallic = 0.2f;
    m.roughness = 0.7f;
    m.sheen_color = {0.9f, 0.7f, 0.5f};
    m.sheen_roughness = 0.6f;
    Scene scene = sphere_scene(m);
    scene.materials[0].normal_texture = add_noise(scene, 32, 1, {64, 64, 192});
    scene.materials[0].sheen_color_texture = add_noise(scene, 16, 2, {128, 128, 128});
    scene.materials[0].sheen_roughness_texture = add_noise(scene, 16, 3, {0, 0, 0}, 128);
    return scene;
}

/// Brushed metal: stretched highlights of a map, turned.
inline Scene brushed_scene() {
    Material m;
    m.base_color = {0.9f, 0.7f, 0.5f, 1.0f};
    m.metallic = 0.8f;
    m.roughness = 0.35f;
    m.normal_scale = 0.2f;
    m.anisotropy_strength = 0.9f;
    m.anisotropy_rotation = 0.6f;
    Scene scene = sphere_scene(m);
    scene.materials[0].normal_texture = add_noise(scene, 32, 1, {0, 0, 192});
    scene.materials[0].anisotropy_texture = add_noise(scene, 16, 2, {160, 64, 128});
    return scene;
}

}  // namespace kilolux
