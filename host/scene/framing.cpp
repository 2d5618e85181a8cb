// SPDX-License-Identifier: Apache-2.0
#include "host/scene/framing.h"

#include <algorithm>
#include <cmath>

#include "host/scene/look_around.h"

namespace kilolux {
namespace {

constexpr double kEyeShare = 0.4;      // of the way from the floor to the box's middle
constexpr double kBackShare = 0.85;    // of the free way behind the eye that it steps back
constexpr double kInsideAngle = 55.0;  // vertical [degree]
constexpr double kNearShare = 1e-3;    // near plane, of the box's diagonal
constexpr std::size_t kOpposite = 16;  // level directions: those of faces in opposite pairs

std::size_t opposite(std::size_t level) {
    return level / kOpposite % 2 == 0 ? level + kOpposite : level - kOpposite;
}

Camera camera_inside(const Scene& scene, const Box& box) {
    const glm::dvec3 down(0, -1, 0);
    glm::dvec3 eye = box.center();
    const LookAround around(scene, box);
    const double to_floor = std::min(around.below(eye), way_out(box, eye, down));
    eye += (1.0 - kEyeShare) * to_floor * down;
    const std::vector<LookAround::Level> levels = around.level(eye);
    const auto free_way = [&](std::size_t i) {
        return std::min(levels[i].distance, way_out(box, eye, levels[i].direction));
    };
    std::size_t best = 0;
    const auto length = [&](std::size_t i) {
        return free_way(i) + kBackShare * free_way(opposite(i));
    };
    for (std::size_t i = 1; i < levels.size(); ++i) {
        if (length(i) > length(best)) best = i;
    }
    const glm::dvec3 forward = levels[best].direction;
    const glm::dvec3 position = eye - kBackShare * free_way(opposite(best)) * forward;
    Camera camera = look_at(position, position + forward, {0, 1, 0}, glm::radians(kInsideAngle));
    camera.z_near = std::min(camera.z_near, kNearShare * glm::length(box.size()));
    return camera;
}

// Factor by which a half height is multiplied.
double height_factor(double made_for, double aspect, Fit fit) {
    if (fit == Fit::height || !(made_for > 0.0)) return 1.0;
    const double factor = made_for / aspect;
    return fit == Fit::both ? std::max(factor, 1.0) : factor;
}

}  // namespace

Camera framing_camera(const Scene& scene, double aspect) {
    const Box box = resting_bounds(scene);
    return scene.kind == SceneKind::interior ? camera_inside(scene, box) : frame_box(box, aspect);
}

double fitted_y_fov(double y_fov, double made_for, double aspect, Fit fit) {
    const double factor = height_factor(made_for, aspect, fit);
    return factor == 1.0 ? y_fov : 2.0 * std::atan(std::tan(0.5 * y_fov) * factor);
}

double fitted_y_extent(double y_extent, double made_for, double aspect, Fit fit) {
    return y_extent * height_factor(made_for, aspect, fit);
}

}  // namespace kilolux
