// SPDX-License-Identifier: Apache-2.0
#include "host/picture/shown_light.h"

#include <algorithm>
#include <cmath>

#include "host/base/formats/srgb.h"
#include "kernels/shared/tone_curve.h"

namespace kilolux {
namespace {

// Light is sought as log2 of its channels.
constexpr double kLeastStops = -20.0;  // code 0
constexpr double kMostStops = 6.0;     // the curves show it as white

double shown_code(double linear) { return 255.0 * linear_to_srgb(std::clamp(linear, 0.0, 1.0)); }

glm::dvec3 code_errors(const glm::dvec3& stops, const glm::dvec3& shown, int curve) {
    const glm::vec3 light(glm::exp2(stops));
    const FV3 c = tone_curve_of(curve, fv3(light.x, light.y, light.z));
    return {shown_code(double{c.x}) - shown_code(shown.x),
            shown_code(double{c.y}) - shown_code(shown.y),
            shown_code(double{c.z}) - shown_code(shown.z)};
}

glm::dmat3 slopes(const glm::dvec3& stops, const glm::dvec3& shown, int curve) {
    constexpr double kStep = 0.01;
    glm::dmat3 out;
    for (int i = 0; i < 3; ++i) {
        glm::dvec3 low = stops, high = stops;
        low[i] -= kStep;
        high[i] += kStep;
        out[i] = (code_errors(high, shown, curve) - code_errors(low, shown, curve)) / (2 * kStep);
    }
    return out;
}

double square(const glm::dvec3& v) { return glm::dot(v, v); }

// Least squares by Levenberg and Marquardt, from `stops` on.
glm::dvec3 nearest_stops(glm::dvec3 stops, const glm::dvec3& shown, int curve) {
    constexpr double kEnough = 1e-4;  // squared codes
    constexpr int kMostSteps = 200;
    glm::dvec3 errors = code_errors(stops, shown, curve);
    double damping = 1.0;
    for (int i = 0; i < kMostSteps && square(errors) > kEnough; ++i) {
        const glm::dmat3 slope = slopes(stops, shown, curve);
        const glm::dmat3 damped = glm::transpose(slope) * slope + damping * glm::dmat3(1.0);
        const glm::dvec3 step = glm::inverse(damped) * (glm::transpose(slope) * errors);
        const glm::dvec3 next =
            glm::clamp(stops - glm::clamp(step, -2.0, 2.0), kLeastStops, kMostStops);
        const glm::dvec3 next_errors = code_errors(next, shown, curve);
        const bool better = square(next_errors) < square(errors);
        damping = std::clamp(damping * (better ? 0.3 : 4.0), 1e-6, 1e9);
        if (!better) continue;
        stops = next;
        errors = next_errors;
    }
    return stops;
}

}  // namespace

// For light colours the search starts from bright light, too: curves that compress highlights
// reach them only from there.
glm::dvec3 light_shown_as(const glm::dvec3& shown, int curve) {
    const glm::dvec3 near = glm::log2(glm::clamp(shown, glm::dvec3(1e-4), glm::dvec3(1.0)));
    const glm::dvec3 low = nearest_stops(near, shown, curve);
    const glm::dvec3 high = nearest_stops(near + 4.0, shown, curve);
    const bool is_low =
        square(code_errors(low, shown, curve)) <= square(code_errors(high, shown, curve));
    return glm::exp2(is_low ? low : high);
}

}  // namespace kilolux
