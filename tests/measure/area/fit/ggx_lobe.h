// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

namespace kilolux {

/// The round GGX lobe D V n.l of kernels/shared/lobes/ggx.h in double. Its normal is +z, the eye
/// lies in the plane of x and z, at x >= 0.
struct RoundLobe {
    double alpha = 1.0, n_dot_v = 1.0;

    glm::dvec3 to_eye() const { return {std::sqrt(1.0 - n_dot_v * n_dot_v), 0.0, n_dot_v}; }

    /// D of a unit half vector.
    double distribution(const glm::dvec3& h) const {
        const double sin2 = h.x * h.x + h.y * h.y, a2 = alpha * alpha;
        const double below = sin2 * (1.0 - a2) + a2;
        return a2 / (std::numbers::pi * below * below);
    }

    /// [1/sr], of the unit direction to the light.
    double value(const glm::dvec3& l) const {
        if (l.z <= 0.0) return 0.0;
        const double a2 = alpha * alpha;
        const auto smith = [&](double z) { return std::sqrt(z * z * (1.0 - a2) + a2); };
        const double visibility = 0.5 / (l.z * smith(n_dot_v) + n_dot_v * smith(l.z));
        return distribution(half_vector(l)) * visibility * l.z;
    }

    glm::dvec3 half_vector(const glm::dvec3& l) const { return glm::normalize(to_eye() + l); }

    /// Schlick's (1 - v.h)^5.
    double schlick(const glm::dvec3& l) const {
        return std::pow(std::max(1.0 - glm::dot(to_eye(), half_vector(l)), 0.0), 5.0);
    }

    /// The direction of the point (u, v) of the unit square, of density() below.
    glm::dvec3 sample(double u, double v) const {
        const double cos2 = (1.0 - u) / (1.0 + (alpha * alpha - 1.0) * u);
        const double sine = std::sqrt(1.0 - cos2), around = 2.0 * std::numbers::pi * v;
        const glm::dvec3 h(sine * std::cos(around), sine * std::sin(around), std::sqrt(cos2));
        return 2.0 * glm::dot(to_eye(), h) * h - to_eye();
    }

    double density(const glm::dvec3& l) const {
        const glm::dvec3 h = half_vector(l);
        return h.z > 0.0 ? distribution(h) * h.z / (4.0 * glm::dot(to_eye(), h)) : 0.0;
    }
};

/// Integrals of a lobe over the hemisphere: all of it, and that times Schlick's (1 - v.h)^5.
struct LobeAlbedo {
    double all = 0.0, rise = 0.0;
};

inline LobeAlbedo albedo_of(const RoundLobe& lobe, int steps) {
    LobeAlbedo sum;
    for (int i = 0; i < steps * steps; ++i) {
        const double u = (i / steps + 0.5) / steps, v = 0.5 * (i % steps + 0.5) / steps;
        const glm::dvec3 l = lobe.sample(u, v);
        if (l.z <= 0.0) continue;
        const double weight = lobe.value(l) / lobe.density(l) / (steps * steps);
        sum.all += weight;
        sum.rise += weight * lobe.schlick(l);
    }
    return sum;
}

/// A cosine lobe that the inverse of [[along, 0, tilt], [0, across, 0], [0, 0, 1]] transforms; its
/// integral is 1.
struct TransformedCosine {
    double along = 1.0, tilt = 0.0, across = 1.0;

    double value(const glm::dvec3& l) const {
        if (l.z <= 0.0) return 0.0;
        const glm::dvec3 q(along * l.x + tilt * l.z, across * l.y, l.z);
        const double square = glm::dot(q, q);
        return along * across * l.z / (std::numbers::pi * square * square);
    }

    /// The direction of the point (u, v) of the unit square, of the density value().
    glm::dvec3 sample(double u, double v) const {
        const double r = std::sqrt(u), around = 2.0 * std::numbers::pi * v, z = std::sqrt(1.0 - u);
        return glm::normalize(glm::dvec3((r * std::cos(around) - tilt * z) / along,
                                         r * std::sin(around) / across, z));
    }
};

/// The distance of a transformed cosine from a lobe of the albedo `all`: the integral of
/// (a - b)^2 / (a + b) over `all`. Half of the samples follow each of both.
inline double lobe_distance(const RoundLobe& lobe, const TransformedCosine& fit, double all,
                            int steps) {
    double sum = 0.0;
    for (int i = 0; i < 2 * steps * steps; ++i) {
        const int at = i / 2;
        const double u = (at / steps + 0.5) / steps, v = 0.5 * (at % steps + 0.5) / steps;
        const glm::dvec3 l = i % 2 ? lobe.sample(u, v) : fit.sample(u, v);
        const double a = lobe.value(l), b = all * fit.value(l);
        const double density = 0.5 * (lobe.density(l) + fit.value(l));
        if (a + b > 0.0 && density > 0.0) sum += (a - b) * (a - b) / (a + b) / density;
    }
    return sum / (2.0 * steps * steps) / all;
}

}  // namespace kilolux
