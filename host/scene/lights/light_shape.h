// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "host/scene/scene.h"

namespace kilolux {

/// Two edges that span a flat light, half of them for rectangles and disks; world axes [m]. Their
/// cross product points the way that the light travels. Zero for other lights.
struct LightEdges {
    glm::dvec3 x{0.0};
    glm::dvec3 y{0.0};
};

/// Of a rectangle or disk half its width and height; of a triangle its edges from the first corner.
LightEdges edges_of(const SceneLight& light);

/// The corners of a triangle by its centroid and its edges from the first corner.
std::array<glm::dvec3, 3> corners_of(const glm::dvec3& centroid, const LightEdges& edges);

/// The area that is seen from straight ahead [m^2]: of a sphere its great circle's; 0 without a
/// size.
double seen_area(const SceneLight& light);

/// The greatest distance of the light's points from its position [m].
double bounding_radius(const SceneLight& light);

/// Makes the light a triangle that shines to the side from which its corners are in
/// counter-clockwise order. Its position is the centroid; without an area it has no direction.
void set_triangle(SceneLight& light, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

/// Makes a point a sphere of this radius [m] and of the same intensity, as `--light-size` does; at
/// 0 such a sphere is a point again. Lights of another kind, with a radius of their own, or with a
/// photometric web stay as they are.
void set_point_size(SceneLight& light, double radius);

/// Makes the light a rectangle with a corner at `corner` and perpendicular edges from there [m],
/// that shines along x cross y.
void set_rectangle(SceneLight& light, const glm::dvec3& corner, const glm::dvec3& x,
                   const glm::dvec3& y);

}  // namespace kilolux
