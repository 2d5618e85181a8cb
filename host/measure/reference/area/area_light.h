// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <glm/glm.hpp>

namespace kilolux {

enum class AreaKind { rectangle, disk, sphere, triangle };

/// A light with a size, in double, as seen from a surface point at the origin. Members as in
/// kernels/shared/area/area_shape.h: a triangle has its centroid and two edges from its first
/// corner. A flat shape shines to the side of half_x x half_y; half_x and half_y need not be
/// perpendicular.
struct AreaShape {
    AreaKind kind = AreaKind::rectangle;
    glm::dvec3 center{0.0};               // [m]
    glm::dvec3 half_x{0.0}, half_y{0.0};  // [m]; not of a sphere
    double radius = 0.0;                  // [m]; of a sphere
    bool two_sided = false;               // of a flat shape
};

struct AreaIntegral {
    glm::dvec3 value{0.0};
    double error = 0.0;  // estimated; of the largest component
};

/// Radiance times BRDF times cosine, or whatever is to be integrated, by unit direction.
using AreaIntegrand = std::function<glm::dvec3(const glm::dvec3& to_light)>;

/// The integral over the solid angle that the shape fills [sr], by Gauss's rules on a grid of cells
/// that are small beside their distance and are split where two rules differ: until the error is
/// below `tolerance` of the integral of the absolute value, or there are 20,000 cells.
AreaIntegral integrate_area(const AreaShape& shape, const AreaIntegrand& integrand,
                            double tolerance = 1e-10);

/// The same over the part above the plane through the origin with this normal. The shape is cut
/// there before the integration.
AreaIntegral integrate_area(const AreaShape& shape, const glm::dvec3& normal,
                            const AreaIntegrand& integrand, double tolerance = 1e-10);

struct AreaCosine {
    double value = 0.0;  // [sr]
    double error = 0.0;  // estimated
};

/// The irradiance [sr] of luminance 1 on a surface with this unit normal.
AreaCosine reference_cosine(const AreaShape& shape, const glm::dvec3& normal);

}  // namespace kilolux
