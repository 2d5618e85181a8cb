// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/scene/scene.h"

namespace kilolux {

/// How a triangle's texture coordinates lie on it: u and v turn as its corners do, the other way,
/// or they say nothing.
enum class UvTurn : std::uint8_t { preserving, mirrored, unknown };

UvTurn uv_turn(std::span<const glm::vec2> texcoords, const std::uint32_t* corner);

/// Directions on a triangle in which its texture coordinates grow, times the same positive number.
struct UvFrame {
    UvTurn turn = UvTurn::unknown;
    glm::dvec3 along_u{0.0}, along_v{0.0};
};

/// Unknown where a direction has no length, or where two corners are one point.
UvFrame uv_frame(const Mesh& mesh, std::span<const glm::vec2> texcoords,
                 const std::uint32_t* corner);

/// Groups the corners that share a tangent as MikkTSpace does (Mikkelsen, "Simulation of Wrinkled
/// Surfaces Revisited", 2008): around vertices of equal position, normal and texture coordinates,
/// triangles of one UvTurn that are connected by edges. Triangles whose turn is unknown join the
/// group that reaches them first. Corners that no group reaches join one at their vertex.
///
/// Vertices of several groups get copies, which are further entries of `elements`; `indices` are
/// those of `rest` and are changed alike. Returns, by vertex, one that names its group.
std::vector<std::uint32_t> split_tangent_groups(const Mesh& rest,
                                                std::span<const glm::vec2> texcoords,
                                                std::vector<std::uint32_t>& elements,
                                                std::vector<std::uint32_t>& indices);

/// What split_tangent_groups() needs for a corner of `rest` beside its results [bytes].
inline constexpr std::size_t kTangentGroupBytes = 4 * sizeof(std::uint32_t);

}  // namespace kilolux
