// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/bounded_loss.h"

#include <algorithm>
#include <iterator>

namespace kilolux {
namespace {

struct AtPoints {
    double loss = 0.0;   // largest of a point
    double reach = 0.0;  // lights in whose range a point lies, mean
};

// Lights without a range and the points at which they are compared.
class TailSamples {
 public:
    TailSamples(std::span<const SceneLight> lights, const Box& box) : box_(box) {
        constexpr std::size_t kMostLights = 4096;
        std::ranges::copy_if(lights, std::back_inserter(lights_), lacks_range);
        step_ = (lights_.size() + kMostLights - 1) / kMostLights;
    }

    AtPoints with(double error_budget) const {
        constexpr int kPoints = 5;  // along an axis
        constexpr int kCount = kPoints * kPoints * kPoints;
        AtPoints out;
        if (box_.empty() || lights_.empty()) return out;
        for (int i = 0; i < kCount; ++i) {
            const glm::dvec3 cell(i % kPoints, i / kPoints % kPoints, i / (kPoints * kPoints));
            const glm::dvec3 p = box_.min + box_.size() * cell / double{kPoints - 1};
            double all = 0.0, kept = 0.0;
            for (std::size_t l = 0; l < lights_.size(); l += step_) {
                const glm::vec3& c = lights_[l].intensity;
                const double intensity = std::max({c.x, c.y, c.z});
                const glm::dvec3 way = lights_[l].position - p;
                const double d2 = std::max(glm::dot(way, way), 1e-6);
                const double range = range_of_light(intensity, error_budget);
                const double part = d2 / (range * range);
                all += intensity / d2;
                if (part >= 1.0) continue;
                kept += intensity / d2 * (1.0 - part * part);
                out.reach += static_cast<double>(step_) / kCount;
            }
            if (all > 0.0) out.loss = std::max(out.loss, 1.0 - kept / all);
        }
        return out;
    }

 private:
    Box box_;
    std::vector<SceneLight> lights_;
    std::size_t step_;
};

}  // namespace

double bounded_loss(std::span<const SceneLight> lights, const Box& box, double error_budget) {
    return TailSamples(lights, box).with(error_budget).loss;
}

double budget_of_sum(std::span<const SceneLight> lights, const Box& box, double error_budget) {
    const TailSamples samples(lights, box);
    AtPoints now = samples.with(error_budget);
    while (now.loss > kMostLost) {
        now = samples.with(error_budget / 2.0);
        if (now.reach > kMostInReach) break;
        error_budget /= 2.0;
    }
    return error_budget;
}

}  // namespace kilolux
