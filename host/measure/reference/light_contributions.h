// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "host/measure/reference/reference.h"
#include "host/picture/pixel_probe.h"

namespace kilolux {

/// The contribution of one light of a pixel's list.
struct LightContribution {
    uint index = 0;             // of the light, see ProbedLight
    double distance = 0.0;      // from the surface [m]
    double range = 0.0;         // [m]
    glm::dvec3 radiance{0.0};   // added to the pixel, in float64
    const char* why_dark = "";  // why it adds 0, in a few words
};

/// One per light of a probed pixel's list, the brightest first. `model`: shading, projection and
/// light_d_min count.
std::vector<LightContribution> light_contributions(const PixelProbe& probe, ReferenceOptions model);

}  // namespace kilolux
