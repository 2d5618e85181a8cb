// SPDX-License-Identifier: Apache-2.0
// A box of six faces with normals: an object seen from outside, or a room seen from inside.
#pragma once

#include "host/scene/animated_scene.h"
#include "host/scene/scene.h"

namespace kilolux {

/// From -size/2 to size/2. `inwards`: its faces face the inside.
inline Mesh box_mesh(const glm::dvec3& size, bool inwards = false) {
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-0.5, 0.5}) {
            glm::dvec3 out(0.0), u(0.0), v(0.0);
            out[axis] = side;
            u[(axis + 1) % 3] = 0.5;
            v[(axis + 2) % 3] = side < 0.0 ? -0.5 : 0.5;
            const auto first = static_cast<std::uint32_t>(mesh.positions.size());
            for (const glm::dvec3& p : {out - u - v, out + u - v, out + u + v, out - u + v}) {
                mesh.positions.emplace_back(p * size);
                mesh.normals.emplace_back((inwards ? -2.0 : 2.0) * out);
            }
            for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) {
                mesh.indices.push_back(first + i);
            }
        }
    }
    for (std::size_t i = 0; inwards && i < mesh.indices.size(); i += 3) {
        std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
    }
    return mesh;
}

/// A scene as the loader returns it, with its kind.
inline Scene box_scene(const glm::dvec3& size, bool inwards = false) {
    Scene scene;
    scene.name = "box";
    scene.meshes.push_back(box_mesh(size, inwards));
    scene.instances.push_back({0, glm::dmat4(1.0)});
    Material material;
    material.metallic = 0.0f;
    material.base_color = {0.5f, 0.5f, 0.5f, 1.0f};
    scene.materials.push_back(material);
    scene.meshes[0].material = 0;
    return AnimatedScene(std::move(scene)).take();
}

}  // namespace kilolux
