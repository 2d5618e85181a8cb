// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "host/measure/reference/area/area_light.h"

namespace kilolux {

/// A part of a light with a size.
struct AreaPart {
    glm::dvec3 to_light{0.0};  // from the surface point at the origin to the part's middle [m]
    double solid_angle = 0.0;  // [sr]; 0 for a flat part that shines the other way
};

/// steps^2 parts of equal area, of a sphere of equal solid angle: for quadrature of what may jump,
/// as visibility does. None of a sphere around the origin.
std::vector<AreaPart> parts_of(const AreaShape& shape, int steps);

}  // namespace kilolux
