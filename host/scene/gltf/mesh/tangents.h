// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "host/scene/scene.h"

namespace kilolux {

/// Derives tangents for a normal map from positions, normals and the texture coordinates that the
/// map uses, as MikkTSpace does: a triangle's direction of growing u is projected into each
/// corner's tangent plane and summed, weighted by the corner's angle, over the triangles of a group
/// (split_tangent_groups()). Unlike MikkTSpace's common code, directions that are exactly opposite
/// are summed, too.
///
/// w is +1 where the image's up is cross(normal, tangent). Where texture coordinates say nothing,
/// any perpendicular of the normal is taken: the result is always finite and unit.
void derive_tangents(Mesh& mesh, const TextureUse& normal_texture,
                     std::span<const std::uint32_t> groups);

/// Makes tangents of a file unit and perpendicular enough to be used: zero ones become any
/// perpendicular of the normal, and w becomes +1 or -1.
void mend_tangents(Mesh& mesh);

}  // namespace kilolux
