// SPDX-License-Identifier: Apache-2.0
// A scene of one quad, and the surface in its middle for a camera.
#pragma once

#include "host/measure/reference/ray_cast_reference.h"

namespace kilolux {

inline constexpr double kRounding = 4e-15;  // a few operations in double

// A quad in the plane z = 0, counter-clockwise from +Z, from (-size, -size) to (size, size).
inline Mesh quad(float size) {
    Mesh mesh;
    mesh.positions = {{-size, -size, 0}, {size, -size, 0}, {size, size, 0}, {-size, size, 0}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.texcoords[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    mesh.material = 0;
    return mesh;
}

inline Scene quad_scene(float size = 10.0f) {
    Scene scene;
    scene.meshes.push_back(quad(size));
    scene.instances.push_back({0, glm::dmat4(1.0)});
    Material material;
    material.base_color = {0.5f, 0.25f, 0.125f, 1.0f};
    material.roughness = 0.75f;
    material.metallic = 0.25f;
    material.emissive = {1, 2, 3};
    scene.materials.push_back(material);
    return scene;
}

inline SurfaceSample center_of(const Scene& scene, const Camera& camera) {
    return RayCaster(scene).cast(camera, 3, 3).at(1, 1);
}

inline Camera front_camera(double distance = 5.0) {
    return look_at({0, 0, distance}, {0, 0, 0}, {0, 1, 0}, 0.9);
}

}  // namespace kilolux
