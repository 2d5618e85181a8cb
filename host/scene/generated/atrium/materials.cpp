// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/atrium/materials.h"

#include <array>
#include <utility>

#include "host/base/system/parallel.h"
#include "host/scene/generated/atrium/textures.h"
#include "kernels/shared/hash.h"

namespace kilolux {
namespace {

using ImageMaker = SurfaceImages (*)(std::uint32_t seed);

// Images by index in kMakers; several materials may share one set.
constexpr int kNoImages = -1;
constexpr std::array<ImageMaker, 13> kMakers = {
    marble_images, limestone_images, brick_images, plaster_images,    tile_images,
    paving_images, voussoir_images,  wood_images,  terracotta_images, mosaic_images,
    water_images,  leaf_images,      cloth_images};

struct NamedMaterial {
    const char* name;
    int images;
    double metres;     // that a texture covers
    bool normal_map;   // tangents needed
    glm::vec3 factor;  // linear, times the texture
    float roughness;
    bool double_sided;
};

constexpr std::array<NamedMaterial, static_cast<std::size_t>(AtriumMaterial::count)> kRows = {{
    {"marble", 0, 2.0, false, {1, 1, 1}, 0.30f, false},
    {"limestone", 1, 2.0, false, {1, 1, 1}, 0.75f, false},
    {"brick", 2, 1.6, true, {1, 1, 1}, 1.0f, false},
    {"plaster", 3, 3.2, true, {1, 1, 1}, 0.85f, false},
    {"tile", 4, 1.6, true, {1, 1, 1}, 1.0f, false},
    {"paving", 5, 3.2, true, {1, 1, 1}, 1.0f, false},
    {"voussoir", 6, 2.0, false, {1, 1, 1}, 0.70f, false},
    {"wood", 7, 1.6, true, {1, 1, 1}, 0.55f, false},
    {"terracotta", 8, 0.8, false, {1, 1, 1}, 0.80f, false},
    {"mosaic", 9, 0.8, false, {1, 1, 1}, 0.25f, false},
    {"water", 10, 2.0, true, {0.03f, 0.12f, 0.13f}, 0.12f, false},
    {"leaf", 11, 0.2, false, {1, 1, 1}, 0.60f, true},
    {"iron", kNoImages, 1.0, false, {0.055f, 0.045f, 0.038f}, 0.45f, false},
    {"glass", kNoImages, 1.0, false, {0.88f, 0.70f, 0.42f}, 0.20f, false},
    {"cloth-red", 12, 0.8, false, {0.62f, 0.07f, 0.06f}, 0.75f, true},
    {"cloth-blue", 12, 0.8, false, {0.07f, 0.16f, 0.50f}, 0.75f, true},
    {"cloth-gold", 12, 0.8, false, {0.80f, 0.48f, 0.08f}, 0.75f, true},
}};

std::vector<SurfaceImages> make_all_images(std::uint64_t seed) {
    std::vector<SurfaceImages> made(kMakers.size());
    parallel_for(std::size_t{0}, made.size(), [&](std::size_t i) {
        made[i] = kMakers[i](static_cast<std::uint32_t>(item_bits(item_key(seed, i), 0)));
    });
    return made;
}

int add_texture(Scene& scene, Image image) {
    if (image.rgba.empty()) return -1;
    scene.images.push_back(std::move(image));
    scene.textures.push_back({static_cast<int>(scene.images.size()) - 1, {}});
    return static_cast<int>(scene.textures.size()) - 1;
}

struct TextureSet {
    int base_color = -1;
    int normal = -1;
    int roughness = -1;
};

}  // namespace

void add_atrium_materials(Scene& scene, std::uint64_t seed) {
    std::vector<TextureSet> sets;
    for (SurfaceImages& images : make_all_images(seed)) {
        TextureSet set;
        set.base_color = add_texture(scene, std::move(images.base_color));
        set.normal = add_texture(scene, std::move(images.normal));
        set.roughness = add_texture(scene, std::move(images.roughness));
        sets.push_back(set);
    }
    for (const NamedMaterial& row : kRows) {
        Material material;
        material.name = row.name;
        material.base_color = glm::vec4(row.factor, 1.0f);
        material.metallic = 0.0f;
        material.roughness = row.roughness;
        material.double_sided = row.double_sided;
        if (row.images != kNoImages) {
            const TextureSet& set = sets[static_cast<std::size_t>(row.images)];
            material.base_color_texture.texture = set.base_color;
            material.normal_texture.texture = set.normal;
            material.metallic_roughness_texture.texture = set.roughness;
        }
        scene.materials.push_back(std::move(material));
    }
}

int add_atrium_mesh(Scene& scene, const char* name, const MeshBuilder& builder,
                    AtriumMaterial material) {
    const auto index = static_cast<int>(material);
    const NamedMaterial& row = kRows[static_cast<std::size_t>(index)];
    return add_mesh(scene, builder.build(name, index, 1.0 / row.metres, row.normal_map));
}

}  // namespace kilolux
