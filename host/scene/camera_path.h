// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/scene/camera.h"

namespace kilolux {

/// Where a camera is at a time, and what it looks at.
struct CameraKey {
    double time = 0.0;            // [s]
    glm::dvec3 position{0.0};     // [m]
    glm::dvec3 focal_point{0.0};  // [m]
    double angle = 45.0;          // vertical [degree]
};

/// A camera that passes smoothly through keys: position and focal point by cubic Hermite splines
/// with the slopes of parabolas through three keys (Catmull-Rom for keys of unequal distance), the
/// angle by one that does not overshoot (Fritsch and Butland 1984). It stands still between keys
/// that are equal, before the first and after the last.
class CameraPath {
 public:
    /// At least one key, of ascending times.
    explicit CameraPath(std::vector<CameraKey> keys);

    /// The camera at a time [s].
    CameraKey at(double time) const;

 private:
    std::vector<CameraKey> keys_;
    std::vector<CameraKey> slopes_;  // a second, at the keys
};

/// `camera` turned by `degrees` about the vertical axis through `centre`, counter-clockwise as seen
/// from above.
Camera turned(Camera camera, const glm::dvec3& centre, double degrees);

}  // namespace kilolux
