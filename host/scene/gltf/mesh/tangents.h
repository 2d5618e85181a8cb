// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/scene.h"

namespace kilolux {

/// Derives tangents for a normal map from positions, normals and the texture coordinates that the
/// map uses, as MikkTSpace does: per triangle the direction of growing u, projected into each
/// corner's tangent plane and summed by the corner's angle over all vertices of equal position,
/// normal and texture coordinate; triangles of mirrored texture coordinates sum apart.
///
/// Vertices where both orientations meet are split, so the mesh's arrays and indices may grow; w is
/// +1 where the image's up is cross(normal, tangent). Unlike MikkTSpace, no connectivity between
/// the triangles around a vertex is asked for. Where texture coordinates say nothing, any
/// perpendicular of the normal is taken: the result is always finite and unit.
void derive_tangents(Mesh& mesh, const TextureUse& normal_texture);

/// Makes tangents of a file unit and perpendicular enough to be used: zero ones become any
/// perpendicular of the normal, and w becomes +1 or -1.
void mend_tangents(Mesh& mesh);

}  // namespace kilolux
