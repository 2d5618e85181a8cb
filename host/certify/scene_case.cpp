// SPDX-License-Identifier: Apache-2.0
#include "host/certify/scene_case.h"

#include <utility>

namespace kilolux {

RenderSettings scene_settings(const Gpu& gpu, int width, int height) {
    RenderSettings settings;
    settings.width = width;
    settings.height = height;
    settings.lights.count = 0;
    settings.kernels.lanes = gpu.info.lane_width;
    settings.device = gpu.info.name;
    settings.opened = std::make_shared<const Gpu>(gpu);
    settings.geometry = Geometry::compute;  // on devices without OpenGL, too
    return settings;
}

void add_quad(Mesh& mesh, const glm::vec2& corner, float width, const glm::vec3& normal) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const glm::vec2 offset : {glm::vec2(0, 0), {width, 0}, {width, 1}, {0, 1}}) {
        mesh.positions.emplace_back(corner + offset, 0.0f);
        mesh.normals.push_back(normal);
    }
    for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + i);
}

Scene quad_scene(Mesh mesh) {
    mesh.material = 0;
    Scene scene;
    scene.name = "quads";
    scene.meshes.push_back(std::move(mesh));
    scene.materials.emplace_back();
    scene.instances.push_back({0, glm::dmat4(1.0)});
    return scene;
}

Camera quad_camera(int width, int height) {
    const glm::dvec3 centre(width / 2.0, height / 2.0, 0.0);
    Camera camera = look_at(centre + glm::dvec3(0, 0, 10), centre, {0, 1, 0}, 1.0);
    camera.orthographic = true;
    camera.y_extent = height / 2.0;
    camera.z_far = 20.0;
    return camera;
}

}  // namespace kilolux
