// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "host/scene/camera.h"
#include "host/scene/framing.h"
#include "host/scene/scene.h"

namespace kilolux {

/// The camera options of the command line; the scene decides those that are not given.
struct CameraChoice {
    std::optional<int> index{};
    bool framed = false;                  // a camera that frames the scene, whatever cameras it has
    SeenFrom view = SeenFrom::automatic;  // other than automatic: framed, unless an index is given
    Fit fit = Fit::both;
    std::optional<glm::dvec3> position{};     // [m]
    std::optional<glm::dvec3> focal_point{};  // [m]
    std::optional<glm::dvec3> view_up{};
    std::optional<double> view_angle{};  // vertical [degree]
    bool orthographic = false;
    bool operator==(const CameraChoice&) const = default;
};

/// A camera's position, its target, and its up direction.
struct CameraPlace {
    glm::dvec3 position{0.0};     // [m]
    glm::dvec3 focal_point{0.0};  // [m]
    glm::dvec3 view_up{0.0, 1.0, 0.0};
};

/// A perspective camera at a place in a scene of `radius` [m], vertical angle `y_fov` [rad]. Throws
/// Error when the directions are degenerate.
Camera place_camera(const CameraPlace& place, double y_fov, double radius);

/// Whether `choice` asks for the camera that frames the scene.
bool is_framed(const CameraChoice& choice, const Scene& scene);

/// The camera that `choice` asks for in `scene`.
///
/// It starts from the camera of the index, else the scene's first, else one that frames the scene
/// (framing_camera()). `aspect` is the picture's, width / height.
/// A position without a focal point looks at the scene's middle; a focal point without a position
/// is seen from where the camera was. A parallel projection shows what the perspective one shows at
/// the focal point, and all of the scene in depth. Throws UsageError for an index the scene does
/// not have, Error when the directions are degenerate.
Camera choose_camera(const CameraChoice& choice, const Scene& scene, double aspect = 16.0 / 9.0);

}  // namespace kilolux
