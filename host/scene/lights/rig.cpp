// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/rig.h"

#include <algorithm>
#include <cmath>

#include "host/base/formats/srgb.h"
#include "host/scene/lights/light_side.h"

namespace kilolux {
namespace {

constexpr double kHeadlight = 2.2;  // [lx]

SceneLight directional(const glm::dvec3& towards_light, const glm::dvec3& illuminance) {
    SceneLight light;
    light.type = LightType::directional;
    light.direction = -glm::normalize(towards_light);
    light.side = perpendicular_side(light.direction);
    light.intensity = glm::vec3(illuminance);
    return light;
}

std::vector<SceneLight> studio() {
    return {directional({-0.8, 1.0, 1.2}, {2.0, 1.9, 1.75}),    // key, a little warm
            directional({1.2, 0.25, 0.9}, {0.55, 0.6, 0.65}),   // fill, a little cool
            directional({0.5, 0.9, -1.2}, {1.3, 1.35, 1.4}),    // rim
            directional({-0.1, 1.0, 0.1}, {0.6, 0.6, 0.6}),     // from above
            directional({-0.9, -0.6, -0.3}, {0.3, 0.3, 0.3})};  // from the floor
}

SceneLight headlight() {
    SceneLight light = directional({0, 0, 1}, glm::dvec3(kHeadlight));
    light.follows_camera = true;
    return light;
}

// A texture's stored colour at a mesh's texture coordinates `texcoord`; white without a texture.
glm::dvec3 texel_of(const Scene& scene, const TextureUse& use, const glm::vec2& texcoord) {
    if (!use.present()) return glm::dvec3(1.0);
    const Texture& texture = scene.textures[static_cast<std::size_t>(use.texture)];
    const Image& image = scene.images[static_cast<std::size_t>(texture.image)];
    const glm::vec2 uv(use.uv_from_texcoord * glm::vec3(texcoord, 1.0f));
    const auto texel = [](float at, int size) {
        const float turn = std::isfinite(at) ? at - std::floor(at) : 0.0f;
        return static_cast<std::size_t>(
            std::min(static_cast<int>(turn * static_cast<float>(size)), size - 1));
    };
    const std::size_t place = texel(uv.y, image.height) * static_cast<std::size_t>(image.width) +
                              texel(uv.x, image.width);
    const std::uint8_t* rgba = &image.rgba[4 * place];
    return glm::dvec3(rgba[0], rgba[1], rgba[2]) / 255.0;
}

// A triangle's mirror reflectance: its metal, or the head-on reflectance of a dielectric.
double metallic_at(const Scene& scene, const Mesh& mesh, std::size_t first) {
    const Material& material = material_of(scene, mesh);
    if (material.unlit) return 0.0;
    const auto middle = [&](const TextureUse& use) {
        const auto& texcoords = mesh.texcoords[static_cast<std::size_t>(use.uv_set)];
        glm::vec2 sum(0.0f);
        for (std::size_t i = first; i < first + 3 && !texcoords.empty(); ++i) {
            sum += texcoords[mesh.indices[i]] / 3.0f;
        }
        return texcoords.empty() ? glm::dvec3(1.0) : texel_of(scene, use, sum);
    };
    const double metal = double{material.metallic} * middle(material.metallic_roughness_texture).z;
    if (!has_own_reflectance(material)) return metal;
    glm::dvec3 mirror(dielectric_reflectance(material));
    const glm::dvec3 encoded = middle(material.specular_color_texture);
    for (glm::length_t c = 0; c < 3; ++c) mirror[c] *= srgb_to_linear(encoded[c]);
    return std::max({metal, mirror.x, mirror.y, mirror.z});
}

}  // namespace

double metallic_share(const Scene& scene) {
    double area = 0.0, metal = 0.0;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        const glm::dmat3 axes(instance.world_from_object);
        for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            const auto corner = [&](std::size_t c) {
                return axes * glm::dvec3(mesh.positions[mesh.indices[i + c]]);
            };
            const double size =
                glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
            if (!std::isfinite(size)) continue;
            area += size;
            metal += size * metallic_at(scene, mesh, i);
        }
    }
    return area > 0.0 ? metal / area : 0.0;
}

Rig automatic_rig(const Scene& scene, bool is_generated) {
    if (!scene.lights.empty()) return Rig::none;
    if (is_generated) return Rig::swarm;
    return scene.kind == SceneKind::interior ? Rig::swarm : Rig::studio;
}

std::vector<SceneLight> rig_lights(Rig rig) {
    if (rig == Rig::studio) return studio();
    if (rig == Rig::headlight) return {headlight()};
    return {};
}

float rig_ambient(Rig rig, float standard) {
    constexpr float kSurroundRadiance = 0.2f;
    return rig == Rig::studio ? kSurroundRadiance : standard;
}

SceneLight placed_light(SceneLight light, const glm::dmat3& world_from_view,
                        const glm::dvec3& camera_position) {
    if (!light.follows_camera) return light;
    light.position = camera_position + world_from_view * light.position;
    light.direction = world_from_view * light.direction;
    light.side = world_from_view * light.side;
    light.follows_camera = false;
    return light;
}

}  // namespace kilolux
