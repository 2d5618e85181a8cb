// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/bounded_loss.h"

#include <algorithm>
#include <iterator>

namespace kilolux {

double bounded_loss(const Scene& scene, double error_budget) {
    constexpr int kPoints = 5;  // along an axis
    constexpr std::size_t kMostLights = 4096;
    const Box box = resting_bounds(scene);
    std::vector<SceneLight> lights;
    std::ranges::copy_if(scene.lights, std::back_inserter(lights), lacks_range);
    if (box.empty() || lights.empty()) return 0.0;
    const std::size_t step = (lights.size() + kMostLights - 1) / kMostLights;
    double most = 0.0;
    for (int i = 0; i < kPoints * kPoints * kPoints; ++i) {
        const glm::dvec3 cell(i % kPoints, i / kPoints % kPoints, i / (kPoints * kPoints));
        const glm::dvec3 p = box.min + box.size() * cell / double{kPoints - 1};
        double all = 0.0, kept = 0.0;
        for (std::size_t l = 0; l < lights.size(); l += step) {
            const glm::vec3& c = lights[l].intensity;
            const double intensity = std::max({c.x, c.y, c.z});
            const glm::dvec3 way = lights[l].position - p;
            const double d2 = std::max(glm::dot(way, way), 1e-6);
            const double range = range_of_light(intensity, error_budget);
            const double part = d2 / (range * range);
            all += intensity / d2;
            if (part < 1.0) kept += intensity / d2 * (1.0 - part * part);
        }
        if (all > 0.0) most = std::max(most, 1.0 - kept / all);
    }
    return most;
}

}  // namespace kilolux
