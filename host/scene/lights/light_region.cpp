// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/light_region.h"

#include <algorithm>

#include "kernels/shared/light.h"

namespace kilolux {
namespace {

constexpr double kWallShare = 0.02;      // of each side of an interior
constexpr double kOpenShare = 0.1;       // of the diagonal
constexpr double kShellShare = 0.25;     // of the diagonal
constexpr double kGapShare = 0.05;       // of the diagonal
constexpr double kFlatShare = 0.05;      // of the diagonal
constexpr double kDMinShare = 0.0025;    // of the diagonal
constexpr double kSmallestDMin = 1e-15;  // [m]; its square is a normal float

Box grown(const Box& box, const glm::dvec3& by) { return {box.min - by, box.max + by}; }

bool is_flat(const Box& box, double diagonal) {
    const glm::dvec3 size = box.size();
    return std::min({size.x, size.y, size.z}) < kFlatShare * diagonal;
}

}  // namespace

LightRegion light_region(const Scene& scene, double gap) {
    if (!scene.light_box.empty()) return {scene.light_box, {}};
    const Box all = resting_bounds(scene);
    const double diagonal = all.empty() ? 0.0 : glm::length(all.size());
    if (!(diagonal > 0.0)) return {Box{glm::dvec3(-1.0), glm::dvec3(1.0)}, {}};
    if (scene.kind == SceneKind::interior) return {grown(all, -kWallShare * all.size()), {}};
    if (scene.kind == SceneKind::open && !is_flat(all, diagonal))
        return {grown(all, glm::dvec3(kOpenShare * diagonal)), {}};
    const double start = std::min(gap, kGapShare * diagonal);
    return {grown(all, glm::dvec3(start + kShellShare * diagonal)), grown(all, glm::dvec3(start))};
}

float light_d_min(const Scene& scene) {
    const Box all = resting_bounds(scene);
    const double share = all.empty() ? 0.0 : kDMinShare * glm::length(all.size());
    double d_min = LIGHT_D_MIN;
    if (!(share > 0.0) || share >= d_min) return LIGHT_D_MIN;
    while (d_min > share && d_min > kSmallestDMin) d_min *= 0.5;
    return static_cast<float>(d_min);
}

}  // namespace kilolux
