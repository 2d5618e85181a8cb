// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "host/scene/scene.h"

namespace kilolux {

/// Derives tangents for a normal map from positions, normals and the texture coordinates that the
/// map uses. As in MikkTSpace, a triangle's direction of growing u is projected into each corner's
/// tangent plane and summed, weighted by the corner's angle, over all vertices of a group.
/// Triangles with mirrored texture coordinates have sums of their own: vertices where both
/// orientations meet are already split (split_mirrored()). `groups`: see equal_vertices().
///
/// Unlike in MikkTSpace, the triangles around a vertex need not be connected, so tangents may
/// differ where surfaces touch at one vertex. w is +1 where the image's up is cross(normal,
/// tangent). Where texture coordinates are degenerate, any perpendicular of the normal is taken:
/// the result is always finite and unit.
void derive_tangents(Mesh& mesh, const TextureUse& normal_texture,
                     const std::vector<std::uint32_t>& groups);

/// By vertex, the first one of equal position, normal and texture coordinate of the normal map.
std::vector<std::uint32_t> equal_vertices(const Mesh& mesh, const TextureUse& normal_texture);

/// Splits groups whose vertices have different values.
void split_groups(std::vector<std::uint32_t>& groups, std::span<const glm::vec4> values);

/// Where a texture is read: `texcoords` as its use transforms them, zeros where there are none.
std::vector<glm::dvec2> map_coordinates(std::span<const glm::vec2> texcoords, const TextureUse& use,
                                        std::size_t vertices);

/// Gives vertices that triangles of both orientations in texture space share a copy for those of
/// the second one: a further entry of `elements`. Only the texture coordinates decide, so that a
/// mesh has the same vertices and indices at any time of an animation.
void split_mirrored(std::span<const glm::dvec2> uvs, std::vector<std::uint32_t>& elements,
                    std::vector<std::uint32_t>& indices);

/// Makes tangents of a file unit and perpendicular enough to be used: zero ones become any
/// perpendicular of the normal, and w becomes +1 or -1.
void mend_tangents(Mesh& mesh);

}  // namespace kilolux
