// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/camera_rays.h"

#include <cmath>

namespace kilolux {

PixelRay pixel_ray(const Camera& camera, int width, int height, int x, int y) {
    const double half_height = camera.orthographic ? camera.y_extent : std::tan(camera.y_fov / 2.0);
    const double half_width = half_height * width / height;
    const double sample_x = x + 0.5 + camera.jitter.x;
    const double sample_y = y + 0.5 + camera.jitter.y;
    const double ndc_x = 2.0 * sample_x / width - 1.0;
    const double ndc_y = 1.0 - 2.0 * sample_y / height;
    const glm::dvec3 at((ndc_x - camera.shear.x) * half_width,
                        (ndc_y - camera.shear.y) * half_height, 0.0);
    const glm::dvec3 dx(2.0 * half_width / width, 0.0, 0.0);
    const glm::dvec3 dy(0.0, -2.0 * half_height / height, 0.0);
    PixelRay ray;
    if (camera.orthographic) {
        ray.origin = at;
        ray.origin_dx = dx;
        ray.origin_dy = dy;
    } else {
        ray.direction = at + glm::dvec3(0.0, 0.0, -1.0);
        ray.direction_dx = dx;
        ray.direction_dy = dy;
    }
    return ray;
}

}  // namespace kilolux
