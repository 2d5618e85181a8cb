// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene.h"

#include <cmath>

namespace kilolux {

Box bounds(const Scene& scene) {
    Box box;
    for (const Instance& instance : scene.instances) {
        for (const glm::vec3& p : scene.meshes[static_cast<std::size_t>(instance.mesh)].positions) {
            box.add(glm::dvec3(instance.world_from_object * glm::dvec4(p, 1.0)));
        }
    }
    return box;
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

std::size_t triangle_count(const Scene& scene) {
    std::size_t count = 0;
    for (const Instance& instance : scene.instances) {
        count += scene.meshes[static_cast<std::size_t>(instance.mesh)].indices.size() / 3;
    }
    return count;
}

}  // namespace kilolux
