// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/reference_sheen.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/shared/lobes/sheen.h"

namespace kilolux {
namespace {

double limited(double roughness) { return std::max(roughness, 0.045); }

// l(x) of the text.
double shadow_exponent(double x, double alpha) {
    const double share = (1.0 - alpha) * (1.0 - alpha);
#define VALUE_OF(name, at_1, at_0) const double name = std::lerp(double{at_1}, double{at_0}, share);
    SHEEN_SHADOW_ROWS(VALUE_OF)
#undef VALUE_OF
    return a / (1.0 + b * std::pow(x, c)) + d * x + e;
}

double lambda(double cosine, double alpha) {
    if (cosine < 0.5) return std::exp(shadow_exponent(cosine, alpha));
    const double x = std::max(1.0 - cosine, 0.0);
    return std::exp(2.0 * shadow_exponent(0.5, alpha) - shadow_exponent(x, alpha));
}

}  // namespace

double reference_sheen(const SurfaceSample& s, const glm::dvec3& to_eye,
                       const glm::dvec3& to_light) {
    const double alpha = limited(s.sheen_roughness) * limited(s.sheen_roughness);
    const double n_dot_v = std::max(glm::dot(s.normal, to_eye), 1e-4);
    const glm::dvec3 sum = to_eye + to_light;
    const glm::dvec3 h = sum / std::max(glm::length(sum), 1e-6);
    const glm::dvec3 across = glm::cross(s.normal, h);
    const double sin2 = std::min(glm::dot(across, across), 1.0);
    const double charlie =
        (2.0 + 1.0 / alpha) * std::pow(sin2, 0.5 / alpha) / (2.0 * std::numbers::pi);
    const double shadow = 1.0 + lambda(std::min(n_dot_v, 1.0), alpha) +
                          lambda(std::clamp(glm::dot(s.normal, to_light), 0.0, 1.0), alpha);
    return charlie / (shadow * 4.0 * n_dot_v);
}

double reference_sheen_albedo(double cosine, double roughness) {
    const double r = limited(roughness);
#define VALUE_OF(name, one, of_r, of_r2, of_r3, of_inverse, of_inverse2)         \
    const double name = double{one} + double{of_r} * r + double{of_r2} * r * r + \
                        double{of_r3} * r * r * r + double{of_inverse} / r +     \
                        double{of_inverse2} / (r * r);
    SHEEN_ALBEDO_ROWS(VALUE_OF)
#undef VALUE_OF
    const double x = cosine;
    return std::exp2(
        std::min(albedo_0 + albedo_1 * x + albedo_2 * x * x + albedo_3 * x * x * x, 0.0));
}

double reference_below_sheen(const SurfaceSample& s, double n_dot_v, double n_dot_l) {
    const double taken = std::max(reference_sheen_albedo(n_dot_v, s.sheen_roughness),
                                  reference_sheen_albedo(n_dot_l, s.sheen_roughness));
    return 1.0 - std::max({s.sheen.x, s.sheen.y, s.sheen.z}) * taken;
}

}  // namespace kilolux
