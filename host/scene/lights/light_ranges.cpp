// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/light_ranges.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/base/error.h"

namespace kilolux {

double range_of_light(double intensity_max_cd, double error_budget) {
    if (!(std::isfinite(intensity_max_cd) && intensity_max_cd >= 0.0)) {
        throw Error(fmt::format("light range: intensity is {} cd, must be finite and >= 0",
                                intensity_max_cd));
    }
    if (!(std::isfinite(error_budget) && error_budget > 0.0)) {
        throw Error(
            fmt::format("light range: error budget is {}, must be finite and > 0", error_budget));
    }
    return std::sqrt(intensity_max_cd / (std::numbers::pi * error_budget));
}

std::size_t fill_missing_ranges(std::vector<SceneLight>& lights, double error_budget) {
    std::size_t filled = 0;
    for (SceneLight& light : lights) {
        // Only 0 means "not given". A light with a negative or non-finite range or intensity stays
        // as it is: make_light_rows() rejects and counts it.
        if (light.type == LightType::directional || light.range != 0.0f) continue;
        const glm::vec3& i = light.intensity;
        if (!std::isfinite(i.x + i.y + i.z) || std::min({i.x, i.y, i.z}) < 0.0f) continue;
        light.range = static_cast<float>(range_of_light(std::max({i.x, i.y, i.z}), error_budget));
        ++filled;
    }
    return filled;
}

}  // namespace kilolux
