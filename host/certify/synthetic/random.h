// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <random>

namespace kilolux {

/// Random numbers that are equal on every machine.
class Random {
 public:
    explicit Random(std::uint32_t seed) : engine_(seed) {}

    std::uint32_t bits() { return static_cast<std::uint32_t>(engine_()); }
    std::uint32_t below(std::uint32_t end) { return bits() % end; }
    double unit() { return bits() / 4294967296.0; }
    double uniform(double low, double high) { return low + (high - low) * unit(); }
    double log_uniform(double low, double high) { return low * std::pow(high / low, unit()); }
    /// In the cube from -extent to extent.
    glm::dvec3 point(double extent) {
        const double x = uniform(-extent, extent);
        const double y = uniform(-extent, extent);
        return {x, y, uniform(-extent, extent)};
    }
    /// Of length 1.
    glm::dvec3 direction() {
        glm::dvec3 v = point(1.0);
        while (glm::dot(v, v) > 1.0 || glm::dot(v, v) < 1e-4) v = point(1.0);
        return glm::normalize(v);
    }

 private:
    std::mt19937 engine_;
};

}  // namespace kilolux
