// SPDX-License-Identifier: Apache-2.0
#include "present/cli/camera_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "host/base/error.h"

namespace kilolux {
namespace {

// The file's camera in a picture of another shape.
Camera fitted(const SceneCamera& made, double aspect, Fit fit) {
    Camera camera = camera_of(made);
    camera.y_fov = fitted_y_fov(made.y_fov, made.aspect, aspect, fit);
    camera.y_extent = fitted_y_extent(made.y_extent, made.aspect, aspect, fit);
    return camera;
}

bool starts_framed(const CameraChoice& choice, const Scene& scene) {
    const bool asked = choice.view != SeenFrom::automatic || scene.cameras.empty();
    return choice.framed || (!choice.index && asked);
}

Camera start_camera(const CameraChoice& choice, const Scene& scene, double aspect) {
    const std::size_t count = scene.cameras.size();
    if (starts_framed(choice, scene)) return framing_camera(scene, aspect);
    const auto index = static_cast<std::size_t>(choice.index.value_or(0));
    if (index < count) return fitted(scene.cameras[index], aspect, choice.fit);
    const std::string known =
        count == 0 ? "it has none" : fmt::format("they are 0 to {}", count - 1);
    throw UsageError(
        fmt::format("--camera-index: {} is no camera of {}; {}", index, scene.name, known));
}

// Nearest and farthest distance of the box's corners along the camera's direction [m].
glm::dvec2 depth_range(const Camera& camera, const Box& box) {
    glm::dvec2 range(std::numeric_limits<double>::infinity(),
                     -std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < 8; ++i) {
        const double depth = -glm::dot(camera.world_from_view[2], box.corner(i) - camera.position);
        range = {std::min(range.x, depth), std::max(range.y, depth)};
    }
    return range;
}

void make_orthographic(Camera& camera, double distance, const Box& box) {
    camera.orthographic = true;
    camera.y_extent = distance * std::tan(0.5 * camera.y_fov);
    const glm::dvec2 range = box.empty() ? glm::dvec2(-1.0, 1.0) : depth_range(camera, box);
    const double margin = 1e-3 * std::max(range.y - range.x, 1e-3);
    camera.z_near = range.x - margin;
    camera.z_far = range.y + margin;
}

// Up as asked for; +Y unless the camera looks along it.
glm::dvec3 up_vector(const CameraChoice& choice, const glm::dvec3& direction) {
    if (choice.view_up) return *choice.view_up;
    const glm::dvec3 up(0, 1, 0);
    const bool along_up = glm::length(glm::cross(direction, up)) <= 1e-6 * glm::length(direction);
    return along_up ? glm::dvec3(0, 0, -1) : up;
}

}  // namespace

Camera place_camera(const CameraPlace& place, double y_fov, double radius) {
    Camera camera = look_at(place.position, place.focal_point, place.view_up, y_fov);
    // The near plane must not cut small scenes; reversed depth keeps its precision there.
    camera.z_near = std::min(camera.z_near, 0.01 * radius);
    return camera;
}

bool is_framed(const CameraChoice& choice, const Scene& scene) {
    return starts_framed(choice, scene) && !choice.position && !choice.focal_point;
}

Camera choose_camera(const CameraChoice& choice, const Scene& scene, double aspect) {
    const Box box = resting_bounds(scene);
    Camera camera = start_camera(choice, scene, aspect);
    const double radius = box.empty() ? 1.0 : 0.5 * glm::length(box.size());
    const glm::dvec3 middle = box.empty() ? glm::dvec3(0.0) : box.center();
    // A scene's camera has no focal point: take one as far away as the scene's middle.
    const double reach = std::max(glm::length(middle - camera.position), 1e-3 * radius);
    glm::dvec3 focal = camera.position - camera.world_from_view[2] * reach;
    if (choice.position) focal = middle;
    if (choice.focal_point) focal = *choice.focal_point;
    const glm::dvec3 position = choice.position.value_or(camera.position);
    const double y_fov = choice.view_angle ? glm::radians(*choice.view_angle) : camera.y_fov;
    if (choice.position || choice.focal_point || choice.view_up) {
        camera =
            place_camera({position, focal, up_vector(choice, focal - position)}, y_fov, radius);
    }
    camera.y_fov = y_fov;
    if (choice.orthographic) make_orthographic(camera, glm::length(focal - position), box);
    return camera;
}

}  // namespace kilolux
