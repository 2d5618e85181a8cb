// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/flip_color.h"

#include <cmath>

namespace kilolux {
namespace {

// Columns: XYZ of red, green and blue. Exact fractions of the sRGB primaries' chromaticities and
// D65 = (0.31271, 0.32902), as in FLIP.
const glm::dmat3 kXyzFromLinear = {
    {10135552.0 / 24577794.0, 2613072.0 / 12288897.0, 1425312.0 / 73733382.0},
    {8788810.0 / 24577794.0, 8788810.0 / 12288897.0, 8788810.0 / 73733382.0},
    {4435075.0 / 24577794.0, 887015.0 / 12288897.0, 70074185.0 / 73733382.0}};
const glm::dmat3 kLinearFromXyz = glm::inverse(kXyzFromLinear);
const glm::dvec3 kWhite = kXyzFromLinear * glm::dvec3(1.0);

// CIE 15:2004, section 8.2.1.1.
double lab_curve(double t) {
    constexpr double kDelta = 6.0 / 29.0;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
}

}  // namespace

glm::dvec3 ycxcz_from_linear(const glm::dvec3& rgb) {
    const glm::dvec3 t = kXyzFromLinear * rgb / kWhite;
    return {116.0 * t.y - 16.0, 500.0 * (t.x - t.y), 200.0 * (t.y - t.z)};
}

glm::dvec3 linear_from_ycxcz(const glm::dvec3& ycxcz) {
    const double y = (ycxcz.x + 16.0) / 116.0;
    return kLinearFromXyz * (glm::dvec3(y + ycxcz.y / 500.0, y, y - ycxcz.z / 200.0) * kWhite);
}

glm::dvec3 hunt_lab_from_linear(const glm::dvec3& rgb) {
    const glm::dvec3 t = kXyzFromLinear * rgb / kWhite;
    const double fx = lab_curve(t.x), fy = lab_curve(t.y), fz = lab_curve(t.z);
    const double lightness = 116.0 * fy - 16.0;
    const double hunt = 0.01 * lightness;
    return {lightness, hunt * 500.0 * (fx - fy), hunt * 200.0 * (fy - fz)};
}

double hyab_distance(const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 d = a - b;
    return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

}  // namespace kilolux
