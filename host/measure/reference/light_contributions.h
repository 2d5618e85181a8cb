// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "host/picture/pixel_probe.h"
#include "host/render/settings.h"

namespace kilolux {

/// What one light of a pixel's list does there.
struct LightShare {
    uint index = 0;            // of the light, see ProbedLight
    double distance = 0.0;     // from the surface [m]
    double range = 0.0;        // [m]
    glm::dvec3 radiance{0.0};  // that it adds to the pixel, in float64
};

/// Of every light in a probed pixel's list, the brightest first. `shading`: not automatic.
std::vector<LightShare> light_shares(const PixelProbe& probe, Shading shading, bool orthographic);

}  // namespace kilolux
