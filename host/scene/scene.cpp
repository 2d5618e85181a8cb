// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

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

namespace {

constexpr std::size_t kVerticesOfTask = 4096;

// Whether a scale of 0 flattens an instance to a point or a line.
bool is_hidden(const Instance& instance) {
    const glm::dmat3 axes(instance.world_from_object);
    return glm::cross(axes[0], axes[1]) == glm::dvec3(0.0) &&
           glm::cross(axes[1], axes[2]) == glm::dvec3(0.0) &&
           glm::cross(axes[2], axes[0]) == glm::dvec3(0.0);
}

Box joined_boxes(Box a, const Box& b) {
    a.min = glm::min(a.min, b.min);
    a.max = glm::max(a.max, b.max);
    return a;
}

Box bounds(const Mesh& mesh, const glm::dmat4& world_from_object) {
    using Range = tbb::blocked_range<std::size_t>;
    const auto add = [&](const Range& range, Box box) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            box.add(glm::dvec3(world_from_object * glm::dvec4(mesh.positions[i], 1.0)));
        }
        return box;
    };
    return tbb::parallel_reduce(Range(0, mesh.positions.size(), kVerticesOfTask), Box{}, add,
                                joined_boxes);
}

}  // namespace

// The order of the vertices changes no box: minima and maxima are exact.
Box bounds(const Scene& scene) {
    using Range = tbb::blocked_range<std::size_t>;
    const auto add = [&](const Range& range, Box box) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            const Instance& instance = scene.instances[i];
            if (is_hidden(instance)) continue;
            const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
            box = joined_boxes(box, bounds(mesh, instance.world_from_object));
        }
        return box;
    };
    return tbb::parallel_reduce(Range(0, scene.instances.size()), Box{}, add, joined_boxes);
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
