// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/light_ranges.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "host/base/error.h"

namespace kilolux {

double range_of_light(double intensity_max_cd, double error_budget) {
    if (!(std::isfinite(intensity_max_cd) && intensity_max_cd >= 0.0)) {
        throw Error("light range: intensity is " + std::to_string(intensity_max_cd) +
                    " cd, must be finite and >= 0");
    }
    if (!(std::isfinite(error_budget) && error_budget > 0.0)) {
        throw Error("light range: error budget is " + std::to_string(error_budget) +
                    ", must be finite and > 0");
    }
    return std::sqrt(intensity_max_cd / (std::numbers::pi * error_budget));
}

std::size_t fill_missing_ranges(std::vector<SceneLight>& lights, double error_budget) {
    std::size_t filled = 0;
    for (SceneLight& light : lights) {
        // Only 0 says "not given". A range or intensity that is no number, or negative, stays as it
        // is: make_light_rows() rejects that light and counts it.
        if (light.type == LightType::directional || light.range != 0.0f) continue;
        const glm::vec3& i = light.intensity;
        if (!std::isfinite(i.x + i.y + i.z) || std::min({i.x, i.y, i.z}) < 0.0f) continue;
        light.range = static_cast<float>(range_of_light(std::max({i.x, i.y, i.z}), error_budget));
        ++filled;
    }
    return filled;
}

}  // namespace kilolux
