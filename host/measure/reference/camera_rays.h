// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/camera.h"

namespace kilolux {

/// The ray through a pixel's sample point in view space, and how it changes to the pixel's right
/// and lower neighbours. Its parameter t is the depth z [m]: p_view = origin + t * direction.
struct PixelRay {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0, 0.0, -1.0};
    glm::dvec3 origin_dx{0.0}, origin_dy{0.0};
    glm::dvec3 direction_dx{0.0}, direction_dy{0.0};
};

/// Of pixel (x, y), row 0 on top, of a picture of width * height.
PixelRay pixel_ray(const Camera& camera, int width, int height, int x, int y);

}  // namespace kilolux
