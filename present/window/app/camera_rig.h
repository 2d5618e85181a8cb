// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace kilolux {

enum class CameraMode { fly, orbit };

/// What input asks of the camera in one frame.
struct CameraInput {
    glm::dvec3 move{0.0};  // -1..1 along right, up, forward: keys held
    glm::dvec2 look{0.0};  // mouse [window heights], right and down: turn (fly) or orbit
    glm::dvec2 pan{0.0};   // mouse [window heights], right and down: orbit's pan
    double wheel = 0.0;    // clicks: speed (fly) or zoom (orbit)
    bool faster = false;
    bool slower = false;
    bool any() const;
};

/// The window's camera: flies, or orbits about a point.
///
/// Until it is moved, it is exactly the camera given. Then it is one that `--camera-position`,
/// `--camera-focal-point` and `--camera-view-angle` describe, with +Y up.
class CameraRig {
 public:
    CameraRig(const Camera& start, const Box& scene_box);

    /// Continues from another camera.
    void set(const Camera& camera);

    /// Steps back until it sees all of the scene.
    void frame();

    /// Moves the camera for `seconds`.
    void move(const CameraInput& motion, CameraMode mode, double seconds);

    const Camera& camera() const { return camera_; }
    const glm::dvec3& focal_point() const { return focal_; }
    /// Whether it is still the camera of set().
    bool is_unmoved() const { return unmoved_; }

    double speed() const { return speed_; }  // of flying [m/s]
    void set_speed(double metres_per_second);

 private:
    void fly(const CameraInput& motion, double seconds);
    void orbit(const CameraInput& motion, double seconds);
    glm::dvec3 turned(const glm::dvec3& direction, const glm::dvec2& radians) const;
    void place(const glm::dvec3& position, const glm::dvec3& focal);

    Box box_;
    double radius_;  // of the scene [m]
    Camera camera_;
    glm::dvec3 focal_{0.0};  // the point that it looks at, and orbits about
    double speed_;
    bool unmoved_ = true;
};

}  // namespace kilolux
