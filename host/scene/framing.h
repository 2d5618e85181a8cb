// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace kilolux {

/// From where a scene without a camera is seen; automatic: by its SceneKind.
enum class SeenFrom { automatic, inside, outside };

/// A camera for a scene that has none, and a picture of `aspect`, width / height.
///
/// An interior (SceneKind) is seen from inside: a little above the floor below the middle of its
/// box, along the level direction with the longest free view, from near its other end. Anything
/// else is seen from outside and whole: frame_box(). By the scene at the time it was loaded for.
Camera framing_camera(const Scene& scene, double aspect);

/// Which field of a camera made for another aspect a picture keeps: its height, its width, or
/// whichever shows all that the camera does.
enum class Fit { height, width, both };

/// Vertical angle [rad] of a perspective camera made for `made_for`, width / height, in a picture
/// of `aspect`. A camera that was made for no aspect (0) keeps its height.
double fitted_y_fov(double y_fov, double made_for, double aspect, Fit fit);

/// The same for half the height of a parallel projection.
double fitted_y_extent(double y_extent, double made_for, double aspect, Fit fit);

}  // namespace kilolux
