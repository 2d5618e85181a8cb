// SPDX-License-Identifier: Apache-2.0
#include "tests/render/ways/way_scenes.h"

#include <cmath>
#include <random>

namespace kilolux {
namespace {

// `least`: of the third channel.
TextureUse add_noise(Scene& scene, int size, const Sampler& sampler, unsigned seed,
                     unsigned least = 64) {
    std::mt19937 random(seed);
    Image image{"noise", size, size, {}};
    for (int i = 0; i < 4 * size * size; ++i) {
        const unsigned from = i % 4 == 2 ? least : 64u;
        image.rgba.push_back(static_cast<std::uint8_t>(from + random() % (256u - from)));
    }
    scene.images.push_back(std::move(image));
    Texture texture;
    texture.image = static_cast<int>(scene.images.size()) - 1;
    texture.sampler = sampler;
    scene.textures.push_back(texture);
    TextureUse use;
    use.texture = static_cast<int>(scene.textures.size()) - 1;
    return use;
}

Sampler trilinear(Wrap wrap) {
    return {wrap, wrap, Filter::linear, Filter::linear, true, Filter::linear};
}

// A material with every map, of different samplers, sets and transforms.
Material mapped_material(Scene& scene) {
    Material m;
    m.base_color_texture = add_noise(scene, 64, trilinear(Wrap::repeat), 1);
    // Normals point outwards: one of nearly zero length would change its direction by rounding.
    m.normal_texture = add_noise(scene, 32, trilinear(Wrap::mirror), 2, 192);
    m.normal_scale = 0.3f;
    m.metallic_roughness_texture = add_noise(scene, 64, trilinear(Wrap::repeat), 3);
    m.occlusion_texture = add_noise(scene, 17, trilinear(Wrap::clamp), 4);
    m.occlusion_texture.uv_set = 1;
    m.emissive_texture = add_noise(scene, 64, trilinear(Wrap::repeat), 5);
    m.emissive_texture.uv_from_texcoord = glm::mat3(1.5f, 0.5f, 0, -0.5f, 1.5f, 0, 0.1f, 0.2f, 1);
    m.emissive = glm::vec3(0.05f);
    m.metallic = 0.5f;
    m.specular_color_texture = add_noise(scene, 64, trilinear(Wrap::repeat), 6);
    m.specular_texture = add_noise(scene, 64, trilinear(Wrap::repeat), 7);
    m.specular = 0.8f;
    return m;
}

// A sheet of hills with all attributes, from -4 to 4 along x and z.
Mesh hills(int material) {
    constexpr int kSide = 9;
    Mesh mesh;
    mesh.material = material;
    for (int i = 0; i < kSide * kSide; ++i) {
        const auto x = static_cast<float>(i % kSide - 4);
        const auto z = static_cast<float>(i / kSide - 4);
        mesh.positions.emplace_back(x, 0.3f * std::sin(x) * std::cos(z), z);
        mesh.normals.push_back(glm::normalize(
            glm::vec3(-0.3f * std::cos(x) * std::cos(z), 1, 0.3f * std::sin(x) * std::sin(z))));
        mesh.tangents.emplace_back(1, 0, 0, 1);
        mesh.texcoords[0].emplace_back(0.3f * x, 0.3f * z);
        mesh.texcoords[1].emplace_back(0.11f * x + 0.5f, 0.13f * z + 0.5f);
        mesh.colors.emplace_back(1, 0.5f + 0.1f * x, 0.9f, 1);
    }
    for (std::uint32_t i = 0; i < kSide * (kSide - 1); ++i) {
        if (i % kSide == kSide - 1) continue;
        mesh.indices.insert(mesh.indices.end(),
                            {i, i + kSide, i + 1, i + 1, i + kSide, i + kSide + 1});
    }
    return mesh;
}

}  // namespace

Scene mapped_scene() {
    Scene scene;
    scene.name = "mapped";
    scene.materials.push_back(mapped_material(scene));
    scene.materials.push_back(mapped_material(scene));
    scene.materials[1].alpha_mode = AlphaMode::mask;
    scene.materials[1].double_sided = true;
    scene.meshes = {hills(0), hills(1)};
    scene.instances.push_back({0, glm::dmat4(1.0)});
    glm::dmat4 above(1.0);
    above[0] = {-0.4, 0.1, 0.0, 0.0};
    above[2] = {0.0, 0.3, 0.5, 0.0};
    above[3] = {0.5, 1.4, -1.0, 1.0};
    scene.instances.push_back({1, above});
    return scene;
}

Scene coated_scene() {
    Scene scene = mapped_scene();
    for (Material& m : scene.materials) {
        // Both do not fit into the targets that OpenGL draws `full` to.
        m.specular_texture = m.specular_color_texture = {};
        m.specular = 1.0f;
        m.clearcoat_texture = add_noise(scene, 64, trilinear(Wrap::repeat), 8);
        m.clearcoat = 0.9f;
        m.clearcoat_roughness_texture = add_noise(scene, 64, trilinear(Wrap::repeat), 9);
        m.clearcoat_roughness = 0.7f;
        m.clearcoat_normal_texture = add_noise(scene, 64, trilinear(Wrap::repeat), 10, 192);
        m.clearcoat_normal_scale = 0.2f;
    }
    return scene;
}

Scene sheen_scene() {
    Scene scene = mapped_scene();
    for (Material& m : scene.materials) {
        m.sheen_color_texture = add_noise(scene, 64, trilinear(Wrap::repeat), 11);
        m.sheen_color = {0.9f, 0.5f, 0.7f};
        m.sheen_roughness_texture = add_noise(scene, 64, trilinear(Wrap::repeat), 12);
        m.sheen_roughness = 0.8f;
    }
    return scene;
}

Scene stretched_scene() {
    Scene scene = mapped_scene();
    for (Material& m : scene.materials) {
        m.anisotropy_texture = add_noise(scene, 64, trilinear(Wrap::repeat), 13);
        // As normals: a direction of nearly zero length would change by rounding.
        std::vector<std::uint8_t>& texels = scene.images.back().rgba;
        for (std::size_t i = 0; i < texels.size(); i += 4) texels[i] |= 0xc0;
        m.anisotropy_strength = 0.9f;
        m.anisotropy_rotation = 0.7f;
    }
    return scene;
}

Scene mapped_scene_with_other_filters() {
    Scene scene = mapped_scene();
    for (std::size_t i = 0; i < scene.textures.size(); ++i) {
        Sampler& sampler = scene.textures[i].sampler;
        if (i % 4 == 1) sampler.between_mipmaps = Filter::nearest;
        if (i % 4 == 2) sampler.mipmaps = false;
        if (i % 4 == 3) sampler.magnify = sampler.minify = Filter::nearest;
    }
    return scene;
}

Camera hill_camera() {
    return look_at({1.0, 1.6, 4.5}, {0, 0.4, -1}, {0, 1, 0}, glm::radians(60.0));
}

GltfBuilder quads_file(const char* alpha_of_mirrored) {
    constexpr int kSide = 32;
    std::mt19937 random(11);
    Blob noise(std::size_t{4} * kSide * kSide);
    for (unsigned char& value : noise) value = static_cast<unsigned char>(64 + random() % 192);
    GltfBuilder file = quad_with_normal_map();
    const int texture = file.add_texture(encode_image("png", kSide, 4, noise), "image/png");
    file.root["materials"][0]["pbrMetallicRoughness"] = {{"baseColorTexture", {{"index", texture}}},
                                                         {"metallicFactor", 0.5},
                                                         {"roughnessFactor", 0.6}};
    file.add_node({{"mesh", 0}, {"translation", {-3, -3, -0.5}}, {"scale", {6, 6, 1}}});
    const auto add_quad = [&](const char* alpha_mode, nlohmann::json node) {
        nlohmann::json material = file.root["materials"][0];
        material["alphaMode"] = alpha_mode;
        material["doubleSided"] = true;
        nlohmann::json primitive = file.primitive();
        primitive["material"] = file.add("materials", material);
        node["mesh"] = file.add("meshes", {{"primitives", {primitive}}});
        return file.add_node(node);
    };
    add_quad(alpha_of_mirrored, {{"translation", {-0.1, 0, 0.1}}, {"scale", {-1, 1.2, 1}}});
    const int turned = add_quad("MASK", {{"translation", {-0.5, -1.1, 0}}});
    const std::vector<float> turns = {0, 0, 0, 1, 0, 0.6f, 0, 0.8f};
    file.add(
        "animations",
        {{"samplers",
          {{{"input", file.add_floats("SCALAR", {0, 1})},
            {"output", file.add_floats("VEC4", turns)}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", turned}, {"path", "rotation"}}}}}}});
    return file;
}

Camera quads_camera() { return look_at({0.2, 0.1, 2.0}, {0, 0, 0}, {0, 1, 0}, glm::radians(60.0)); }

}  // namespace kilolux
