// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/mesh/normals.h"

#include <algorithm>
#include <cmath>

namespace kilolux {
namespace {

constexpr glm::vec3 kAnyNormal(0.0f, 0.0f, 1.0f);

glm::vec3 unit_or(const glm::dvec3& v, const glm::vec3& otherwise) {
    // Scaled first, so that the square neither overflows nor vanishes.
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    if (!(largest > 0.0) || !std::isfinite(largest)) return otherwise;
    if (is_unit(v)) return glm::vec3(v);
    return glm::vec3(glm::normalize(v / largest));
}

bool is_usable(const glm::vec3& v) {
    const glm::dvec3 d(v);
    const double length2 = glm::dot(d, d);
    return length2 > 0.0 && std::isfinite(length2);
}

}  // namespace

bool is_unit(const glm::dvec3& v) {
    constexpr double kRounding = 1e-6;
    return std::abs(glm::dot(v, v) - 1.0) <= kRounding;
}

glm::dvec3 triangle_cross(const Mesh& mesh, std::size_t triangle) {
    const glm::dvec3 a(mesh.positions[mesh.indices[3 * triangle]]);
    const glm::dvec3 b(mesh.positions[mesh.indices[3 * triangle + 1]]);
    const glm::dvec3 c(mesh.positions[mesh.indices[3 * triangle + 2]]);
    return glm::cross(b - a, c - a);
}

void derive_flat_normals(Mesh& mesh) {
    mesh.normals.assign(mesh.positions.size(), kAnyNormal);
    for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
        const glm::vec3 normal = unit_or(triangle_cross(mesh, t), kAnyNormal);
        for (std::size_t c = 0; c < 3; ++c) mesh.normals[mesh.indices[3 * t + c]] = normal;
    }
}

void mend_normals(Mesh& mesh) {
    std::vector<glm::dvec3> around;
    for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
        if (is_usable(mesh.normals[v])) {
            mesh.normals[v] = unit_or(glm::dvec3(mesh.normals[v]), kAnyNormal);
            continue;
        }
        if (around.empty()) {
            around.assign(mesh.positions.size(), glm::dvec3(0.0));
            for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
                const glm::dvec3 cross = triangle_cross(mesh, t);
                for (std::size_t c = 0; c < 3; ++c) around[mesh.indices[3 * t + c]] += cross;
            }
        }
        mesh.normals[v] = unit_or(around[v], kAnyNormal);
    }
}

glm::vec3 any_perpendicular(const glm::vec3& n) {
    // Duff et al. 2017, "Building an Orthonormal Basis, Revisited", JCGT 6(1), listing 3.
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    return {1.0f + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x};
}

}  // namespace kilolux
