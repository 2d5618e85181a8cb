// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/light_ranges.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/base/error.h"
#include "host/scene/lights/light_kinds.h"
#include "host/scene/lights/light_shape.h"

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

bool lacks_range(const SceneLight& light) {
    // Only 0 means "not given". make_light_rows() rejects and counts unusable lights.
    if (!kind_of(light).is_placed || light.range != 0.0f) return false;
    const glm::vec3& i = light.intensity;
    return std::isfinite(i.x + i.y + i.z) && std::min({i.x, i.y, i.z}) >= 0.0f;
}

void fill_missing_ranges(std::vector<SceneLight>& lights, Tails tails, double error_budget) {
    const bool unlimited = tails == Tails::exact || tails == Tails::tree;
    for (SceneLight& light : lights) {
        if (!lacks_range(light)) continue;
        const glm::vec3& i = light.intensity;
        light.has_own_range = unlimited;
        if (unlimited) {
            light.range = kUnlimitedRange;
            continue;
        }
        // About the position; no point of a light with a size is farther from it than that.
        const double range = range_of_light(std::max({i.x, i.y, i.z}), error_budget);
        light.range = static_cast<float>(range + bounding_radius(light));
    }
}

Tails tails_for(std::span<const SceneLight> lights, Tails asked, double error_budget) {
    if (asked != Tails::automatic) return asked;
    if (error_budget != kDefaultRangeBudget) return Tails::bounded;
    const auto unranged = std::ranges::count_if(lights, lacks_range);
    return static_cast<std::size_t>(unranged) <= kExactTails ? Tails::exact : Tails::bounded;
}

}  // namespace kilolux
