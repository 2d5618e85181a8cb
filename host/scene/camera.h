// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "host/scene/scene.h"
#include "kernels/shared/view.h"

namespace kilolux {

/// A pinhole or parallel camera in the world, in double until it becomes a View.
struct Camera {
    glm::dvec3 position{0.0};         // [m]
    glm::dmat3 world_from_view{1.0};  // columns: right, up, backward; orthonormal
    bool orthographic = false;
    double y_fov = 0.785398163397448;  // vertical [rad]
    double y_extent = 1.0;             // half height [m], orthographic
    double z_near = 0.1;               // [m]; perspective > 0; orthographic may be 0 or negative
    double z_far = std::numeric_limits<double>::infinity();  // [m]; > z_near; orthographic: finite
    glm::dvec2 shear{0.0};   // off-centre: added to ndc x, y (stereo, tiles)
    glm::dvec2 jitter{0.0};  // sub-pixel offset of the sample from the pixel's centre [pixel]
    bool operator==(const Camera&) const = default;
};

/// Camera at `position` looking at `focal_point`; throws Error when the two or `up` are degenerate.
Camera look_at(glm::dvec3 position, glm::dvec3 focal_point, glm::dvec3 up, double y_fov_rad);

/// The camera of a scene file.
Camera camera_of(const SceneCamera& camera);

/// A scene file's camera for `camera`: the inverse of camera_of().
SceneCamera scene_camera_of(const Camera& camera, std::string name);

/// A camera that sees the whole box from its front and a little above, in a picture of `aspect`,
/// width / height, or wider.
Camera frame_box(const Box& box, double aspect = 1.0);

/// The camera's world transform as one matrix.
glm::dmat4 world_from_camera(const Camera& camera);

/// Clip space from view space for GL with upper-left origin and [0,1] reversed depth, in double.
glm::dmat4 clip_from_view(const Camera& camera, int width, int height);

/// What kernels need of the camera for an image of width x height pixels.
View view_of(const Camera& camera, int width, int height);

}  // namespace kilolux
