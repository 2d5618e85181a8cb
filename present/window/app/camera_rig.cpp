// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/camera_rig.h"

#include <algorithm>
#include <cmath>

#include "present/cli/camera_choice.h"

namespace kilolux {
namespace {

constexpr glm::dvec3 kUp(0.0, 1.0, 0.0);
constexpr double kSteepest = 1.55;      // of the direction above the horizon [rad]
constexpr double kTurnPerHeight = 2.2;  // dragging over the window's height [rad]
constexpr double kSpeedPerClick = 1.25;
constexpr double kDistancePerClick = 0.88;
constexpr double kFastFactor = 4.0;
constexpr double kSpeedRange = 1e4;  // from the slowest to the fastest

}  // namespace

bool CameraInput::any() const {
    const bool moves = move != glm::dvec3(0.0) || look != glm::dvec2(0.0);
    return moves || pan != glm::dvec2(0.0) || wheel != 0.0;
}

CameraRig::CameraRig(const Camera& start, const Box& scene_box)
    : box_(scene_box),
      radius_(scene_box.empty() ? 1.0 : std::max(0.5 * glm::length(scene_box.size()), 1e-6)),
      speed_(0.12 * radius_) {
    set(start);
}

void CameraRig::set(const Camera& camera) {
    camera_ = camera;
    const glm::dvec3 middle = box_.empty() ? glm::dvec3(0.0) : box_.center();
    // The focal point lies ahead at the distance of the scene's middle, as in choose_camera().
    const double reach = std::max(glm::length(middle - camera.position), 1e-3 * radius_);
    focal_ = camera.position - camera.world_from_view[2] * reach;
    unmoved_ = true;
}

void CameraRig::place(const glm::dvec3& position, const glm::dvec3& focal) {
    Camera placed = place_camera({position, focal, kUp}, camera_.y_fov, radius_);
    if (camera_.orthographic) {
        placed.orthographic = true;
        placed.y_extent = camera_.y_extent;
        placed.z_near = camera_.z_near;
        placed.z_far = camera_.z_far;
    }
    camera_ = placed;
    focal_ = focal;
    unmoved_ = false;
}

void CameraRig::set_speed(double metres_per_second) {
    const double range = std::sqrt(kSpeedRange);
    speed_ = std::clamp(metres_per_second, 0.12 * radius_ / range, 0.12 * radius_ * range);
}

void CameraRig::frame() {
    const glm::dvec3 middle = box_.empty() ? glm::dvec3(0.0) : box_.center();
    const double distance = radius_ / std::sin(0.5 * camera_.y_fov);
    const glm::dvec3 forward = turned(-camera_.world_from_view[2], glm::dvec2(0.0));
    place(middle - forward * distance, middle);
}

// A direction turned right and down, never quite straight up or down.
glm::dvec3 CameraRig::turned(const glm::dvec3& direction, const glm::dvec2& radians) const {
    const double yaw = std::atan2(direction.x, -direction.z) + radians.x;
    const double flat = std::hypot(direction.x, direction.z);
    const double pitch =
        std::clamp(std::atan2(direction.y, flat) - radians.y, -kSteepest, kSteepest);
    return {std::cos(pitch) * std::sin(yaw), std::sin(pitch), -std::cos(pitch) * std::cos(yaw)};
}

void CameraRig::move(const CameraInput& motion, CameraMode mode, double seconds) {
    if (!motion.any()) return;
    if (mode == CameraMode::fly) {
        fly(motion, seconds);
    } else {
        orbit(motion, seconds);
    }
}

void CameraRig::fly(const CameraInput& motion, double seconds) {
    if (motion.wheel != 0.0) set_speed(speed_ * std::pow(kSpeedPerClick, motion.wheel));
    if (motion.move == glm::dvec3(0.0) && motion.look == glm::dvec2(0.0)) return;
    const double reach = std::max(glm::length(focal_ - camera_.position), 1e-6 * radius_);
    const glm::dvec3 forward =
        turned(-camera_.world_from_view[2],
               kTurnPerHeight * (camera_.y_fov / glm::radians(45.0)) * motion.look);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, kUp));
    double metres = speed_ * seconds;
    if (motion.faster) metres *= kFastFactor;
    if (motion.slower) metres /= kFastFactor;
    const glm::dvec3 step = motion.move.x * right + motion.move.y * kUp + motion.move.z * forward;
    const glm::dvec3 position = camera_.position + metres * step;
    place(position, position + reach * forward);
}

void CameraRig::orbit(const CameraInput& motion, double seconds) {
    const glm::dvec3 offset = camera_.position - focal_;
    double distance = std::max(glm::length(offset), 1e-6 * radius_);
    const glm::dvec2 keys(motion.move.x, motion.move.y);
    const glm::dvec3 forward =
        turned(-offset, 2.0 * kTurnPerHeight * motion.look + seconds * glm::dvec2(keys.x, -keys.y));
    const double nearer = motion.wheel + 8.0 * seconds * motion.move.z;
    distance =
        std::clamp(distance * std::pow(kDistancePerClick, nearer), 1e-4 * radius_, 1e3 * radius_);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, kUp));
    const glm::dvec3 up = glm::cross(right, forward);
    // A drag over the window's height moves the focal plane by its visible height.
    const double metres = 2.0 * distance * std::tan(0.5 * camera_.y_fov);
    const glm::dvec3 focal = focal_ + metres * (motion.pan.y * up - motion.pan.x * right);
    if (camera_.orthographic) camera_.y_extent *= std::pow(kDistancePerClick, nearer);
    place(focal - distance * forward, focal);
}

}  // namespace kilolux
