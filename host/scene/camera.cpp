// SPDX-License-Identifier: Apache-2.0
#include "host/scene/camera.h"

#include <cmath>

#include "host/base/error.h"

namespace kilolux {
namespace {

// Half width and half height of the image plane at distance 1 (perspective) or in metres.
glm::dvec2 half_extent(const Camera& camera, int width, int height) {
    const double y = camera.orthographic ? camera.y_extent : std::tan(0.5 * camera.y_fov);
    return {y * width / height, y};
}

glm::dmat3 basis(const glm::dvec3& forward, const glm::dvec3& up) {
    const glm::dvec3 right = glm::normalize(glm::cross(forward, up));
    return {right, glm::cross(right, forward), -forward};
}

}  // namespace

Camera look_at(glm::dvec3 position, glm::dvec3 focal_point, glm::dvec3 up, double y_fov_rad) {
    const glm::dvec3 forward = focal_point - position;
    if (!(glm::length(forward) > 0.0)) {
        throw Error("camera: position and focal point are the same point");
    }
    const glm::dvec3 unit = glm::normalize(forward);
    if (!(glm::length(glm::cross(unit, up)) > 1e-9 * glm::length(up))) {
        throw Error("camera: view-up is zero or parallel to the viewing direction");
    }
    Camera camera;
    camera.position = position;
    camera.world_from_view = basis(unit, up);
    camera.y_fov = y_fov_rad;
    return camera;
}

Camera camera_of(const SceneCamera& source) {
    const glm::dmat3 axes(source.world_from_camera);
    Camera camera;
    camera.position = glm::dvec3(source.world_from_camera[3]);
    camera.world_from_view = basis(-glm::normalize(axes[2]), glm::normalize(axes[1]));
    camera.orthographic = source.orthographic;
    camera.y_fov = source.y_fov;
    camera.y_extent = source.y_extent;
    camera.z_near = source.z_near;
    camera.z_far = source.z_far;
    return camera;
}

glm::dmat4 world_from_camera(const Camera& camera) {
    glm::dmat4 m(camera.world_from_view);
    m[3] = glm::dvec4(camera.position, 1.0);
    return m;
}

SceneCamera scene_camera_of(const Camera& camera, std::string name) {
    return {.name = std::move(name),
            .world_from_camera = world_from_camera(camera),
            .orthographic = camera.orthographic,
            .y_fov = camera.y_fov,
            .y_extent = camera.y_extent,
            .z_near = camera.z_near,
            .z_far = camera.z_far};
}

Camera frame_box(const Box& box, double aspect) {
    constexpr double kYFov = glm::radians(45.0);
    constexpr double kFilled = 0.98;  // of the picture, by the box
    if (box.empty()) return look_at({0, 0, 1}, {0, 0, 0}, {0, 1, 0}, kYFov);
    const glm::dvec3 centre = box.center();
    const glm::dvec3 backward = glm::normalize(glm::dvec3(0.35, 0.3, 1.0));
    Camera camera = look_at(centre + backward, centre, {0, 1, 0}, kYFov);
    const double radius = std::max(0.5 * glm::length(box.size()), 1e-6);
    const double half_height = kFilled * std::tan(0.5 * kYFov);
    double distance = radius;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 sign((corner & 1) - 0.5, (corner >> 1 & 1) - 0.5, (corner >> 2) - 0.5);
        const glm::dvec3 p = glm::abs((box.size() * sign) * camera.world_from_view);
        const double depth = ((box.size() * sign) * camera.world_from_view).z;
        distance =
            std::max(distance, depth + std::max(p.y / half_height, p.x / (half_height * aspect)));
    }
    camera.position = centre + backward * distance;
    camera.z_near = std::max(distance - 2 * radius, radius * 1e-3);
    return camera;
}

glm::dmat4 clip_from_view(const Camera& camera, int width, int height) {
    const glm::dvec2 extent = half_extent(camera, width, height);
    // Moving the sample right and down is moving the picture left and up.
    const glm::dvec2 offset =
        camera.shear + glm::dvec2(-2.0 * camera.jitter.x / width, 2.0 * camera.jitter.y / height);
    const double n = camera.z_near;
    const double f = camera.z_far;
    glm::dmat4 m(0.0);
    m[0][0] = 1.0 / extent.x;
    m[1][1] = 1.0 / extent.y;
    if (camera.orthographic) {
        m[2][2] = 1.0 / (f - n);
        m[3] = glm::dvec4(offset, f / (f - n), 1.0);
        return m;
    }
    m[2] = glm::dvec4(-offset, 0.0, -1.0);
    m[2][2] = std::isinf(f) ? 0.0 : n / (f - n);
    m[3][2] = std::isinf(f) ? n : n * f / (f - n);
    return m;
}

View view_of(const Camera& camera, int width, int height) {
    const glm::dvec2 extent = half_extent(camera, width, height);
    const glm::dmat4 clip = clip_from_view(camera, width, height);
    const glm::dvec2 offset = camera.orthographic ? glm::dvec2(clip[3]) : -glm::dvec2(clip[2]);
    // ndc.x = 2 px / width - 1, ndc.y = 1 - 2 py / height (upper-left origin); x_view = (ndc.x -
    // offset.x) * extent.x.
    View view{};
    view.ray = {static_cast<float>(2.0 * extent.x / width),
                static_cast<float>((-1.0 - offset.x) * extent.x),
                static_cast<float>(-2.0 * extent.y / height),
                static_cast<float>((1.0 - offset.y) * extent.y)};
    const double n = camera.z_near;
    const double f = camera.z_far;
    if (camera.orthographic) {
        view.depth = {static_cast<float>(n - f), 0.0f, 0.0f, static_cast<float>(f)};
    } else {
        view.depth = {static_cast<float>(1.0 / n - 1.0 / f), 0.0f, 0.0f,
                      static_cast<float>(1.0 / f)};
    }
    view.width = static_cast<uint>(width);
    view.height = static_cast<uint>(height);
    view.stride = (view.width + 15u) / 16u * 16u;
    view.orthographic = camera.orthographic ? 1u : 0u;
    const glm::mat3 rotation(glm::transpose(camera.world_from_view));
    view.view_from_world_x = {rotation[0][0], rotation[1][0], rotation[2][0], 0.0f};
    view.view_from_world_y = {rotation[0][1], rotation[1][1], rotation[2][1], 0.0f};
    view.view_from_world_z = {rotation[0][2], rotation[1][2], rotation[2][2], 0.0f};
    const glm::vec3 position(camera.position);
    view.camera_position = {position.x, position.y, position.z, 0.0f};
    return view;
}

}  // namespace kilolux
