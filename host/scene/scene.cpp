// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene.h"

#include <algorithm>
#include <cmath>

namespace kilolux {

glm::vec3 dielectric_reflectance(const Material& material) {
    // The default ior gives exactly the constant of kernels/shared/evaluate.h.
    const float root = (material.ior - 1.0f) / (material.ior + 1.0f);
    const float f0 = material.ior == Material{}.ior ? 0.04f : root * root;
    return f0 * material.specular_color;
}

bool has_own_reflectance(const Material& material) {
    const Material standard;
    return material.ior != standard.ior || material.specular != standard.specular ||
           material.specular_color != standard.specular_color ||
           material.specular_texture.present() || material.specular_color_texture.present();
}

std::size_t zero_normal_count(const Scene& scene) {
    std::size_t count = 0;
    for (const Mesh& mesh : scene.meshes) {
        for (const glm::vec3& n : mesh.normals) {
            const float size = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
            if (!(size > 0.0f && std::isfinite(size))) ++count;
        }
    }
    return count;
}

Box resting_bounds(const Scene& scene) {
    return scene.still_box.empty() ? bounds(scene) : scene.still_box;
}

std::size_t triangle_count(const Scene& scene) {
    std::size_t count = 0;
    for (const Instance& instance : scene.instances) {
        count += scene.meshes[static_cast<std::size_t>(instance.mesh)].indices.size() / 3;
    }
    return count;
}

const Material& material_of(const Scene& scene, const Mesh& mesh) {
    static const Material kDefault;
    return mesh.material == kDefaultMaterial
               ? kDefault
               : scene.materials[static_cast<std::size_t>(mesh.material)];
}

std::size_t material_row(const Scene& scene, const Mesh& mesh) {
    return mesh.material == kDefaultMaterial ? scene.materials.size()
                                             : static_cast<std::size_t>(mesh.material);
}

bool is_blended(const Scene& scene, const Mesh& mesh) {
    return material_of(scene, mesh).alpha_mode == AlphaMode::blend;
}

bool has_blended_surfaces(const Scene& scene) {
    return std::ranges::any_of(scene.instances, [&](const Instance& instance) {
        return is_blended(scene, scene.meshes[static_cast<std::size_t>(instance.mesh)]);
    });
}

}  // namespace kilolux
