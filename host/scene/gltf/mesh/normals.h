// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/scene.h"

namespace kilolux {

/// Gives every vertex its triangle's normal. No vertex may be shared between triangles; those of
/// triangles without area get +Z.
void derive_flat_normals(Mesh& mesh);

/// Makes all normals unit. Those that are zero or not finite become the area-weighted mean of the
/// triangles around, or +Z where those have no area.
void mend_normals(Mesh& mesh);

/// Whether a vector is unit to within float32's rounding. Such vectors are not normalised again, so
/// that an exported scene is read back with the same bits.
bool is_unit(const glm::dvec3& v);

/// Some unit vector perpendicular to a unit normal, continuous almost everywhere.
glm::vec3 any_perpendicular(const glm::vec3& normal);

/// Cross product of two edges of a triangle, in double: its length is twice the area.
glm::dvec3 triangle_cross(const Mesh& mesh, std::size_t triangle);

}  // namespace kilolux
