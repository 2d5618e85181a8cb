// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/mesh/tangents.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/base/system/parallel.h"
#include "host/scene/gltf/mesh/normals.h"
#include "host/scene/gltf/mesh/tangent_groups.h"

namespace kilolux {
namespace {

constexpr std::size_t kVerticesOfTask = 1024;

// What the triangles of a group add up to.
struct GroupSum {
    glm::dvec3 tangent{0.0};
    UvTurn turn = UvTurn::unknown;
};

// Where and how a texture is read.
struct MapCoordinates {
    std::span<const glm::vec2> texcoords;
    glm::dmat3 uv_from_texcoord;
};

// The unit direction in which the map's u grows on a triangle, and how the map's u and v turn.
GroupSum triangle_tangent(const Mesh& mesh, const MapCoordinates& map,
                          const std::uint32_t* corner) {
    const UvFrame frame = uv_frame(mesh, map.texcoords, corner);
    const glm::dmat3& m = map.uv_from_texcoord;
    const double determinant = m[0][0] * m[1][1] - m[1][0] * m[0][1];
    if (frame.turn == UvTurn::unknown || determinant == 0.0) return {};
    const bool is_preserving = (frame.turn == UvTurn::preserving) == (determinant > 0.0);
    // The first column of the inverse, times the determinant's size.
    const double sign = determinant > 0.0 ? 1.0 : -1.0;
    const glm::dvec3 along_u = sign * (frame.along_u * m[1][1] - frame.along_v * m[0][1]);
    const double length = glm::length(along_u);
    if (!(length > 0.0 && std::isfinite(length))) return {};
    return {along_u / length, is_preserving ? UvTurn::preserving : UvTurn::mirrored};
}

// v projected into the plane perpendicular to n, unit; zero where v is parallel to n.
glm::dvec3 in_plane(const glm::dvec3& v, const glm::dvec3& n) {
    const glm::dvec3 flat = v - n * glm::dot(n, v);
    const double length = glm::length(flat);
    return length > 1e-12 * glm::length(v) && length > 0.0 ? flat / length : glm::dvec3(0.0);
}

// What a triangle adds to the sums of its corners.
std::array<glm::dvec3, 3> corner_tangents(const Mesh& mesh, std::size_t triangle,
                                          const glm::dvec3& tangent) {
    const std::uint32_t* corner = &mesh.indices[3 * triangle];
    std::array<glm::dvec3, 3> out;
    for (std::size_t c = 0; c < 3; ++c) {
        const glm::dvec3 normal(mesh.normals[corner[c]]);
        const glm::dvec3 p(mesh.positions[corner[c]]);
        const glm::dvec3 to_next =
            in_plane(glm::dvec3(mesh.positions[corner[(c + 1) % 3]]) - p, normal);
        const glm::dvec3 to_last =
            in_plane(glm::dvec3(mesh.positions[corner[(c + 2) % 3]]) - p, normal);
        const double angle = std::acos(std::clamp(glm::dot(to_next, to_last), -1.0, 1.0));
        out[c] = angle * in_plane(tangent, normal);
    }
    return out;
}

// Adds triangles in their order, so that threads change no bit; parts bound the memory.
std::vector<GroupSum> sum_tangents(const Mesh& mesh, const MapCoordinates& map,
                                   std::span<const std::uint32_t> groups) {
    constexpr std::size_t kPart = 16384;
    const std::size_t triangles = map.texcoords.empty() ? 0 : mesh.indices.size() / 3;
    std::vector<GroupSum> sums(mesh.positions.size());
    std::vector<UvTurn> turns(std::min(kPart, triangles));
    std::vector<std::array<glm::dvec3, 3>> part(turns.size());
    for (std::size_t begin = 0; begin < triangles; begin += kPart) {
        const std::size_t end = std::min(begin + kPart, triangles);
        const auto add_triangle = [&](std::size_t t) {
            const GroupSum own = triangle_tangent(mesh, map, &mesh.indices[3 * t]);
            turns[t - begin] = own.turn;
            part[t - begin] = corner_tangents(mesh, t, own.tangent);
        };
        parallel_for(begin, end, add_triangle, kVerticesOfTask);
        for (std::size_t t = begin; t < end; ++t) {
            if (turns[t - begin] == UvTurn::unknown) continue;
            for (std::size_t c = 0; c < 3; ++c) {
                GroupSum& sum = sums[groups[mesh.indices[3 * t + c]]];
                sum.tangent += part[t - begin][c];
                sum.turn = turns[t - begin];
            }
        }
    }
    return sums;
}

glm::vec4 tangent_of(const glm::vec3& normal, const GroupSum& sum) {
    const glm::dvec3 flat = in_plane(sum.tangent, glm::dvec3(normal));
    const bool usable = glm::dot(flat, flat) > 0.0;
    // v grows downwards in glTF's images: where u and v preserve orientation, up is -cross(n, t).
    const float w = usable && sum.turn == UvTurn::preserving ? -1.0f : 1.0f;
    return {usable ? glm::vec3(flat) : any_perpendicular(normal), w};
}

}  // namespace

void derive_tangents(Mesh& mesh, const TextureUse& normal_texture,
                     std::span<const std::uint32_t> groups) {
    const MapCoordinates map{mesh.texcoords[static_cast<std::size_t>(normal_texture.uv_set)],
                             glm::dmat3(normal_texture.uv_from_texcoord)};
    const std::vector<GroupSum> sums = sum_tangents(mesh, map, groups);
    mesh.tangents.resize(mesh.positions.size());
    const auto put_tangent = [&](std::size_t v) {
        mesh.tangents[v] = tangent_of(mesh.normals[v], sums[groups[v]]);
    };
    parallel_for(std::size_t{0}, mesh.positions.size(), put_tangent, kVerticesOfTask);
}

void mend_tangents(Mesh& mesh) {
    for (std::size_t v = 0; v < mesh.tangents.size(); ++v) {
        glm::vec4& tangent = mesh.tangents[v];
        const glm::dvec3 direction(tangent);
        const double length = glm::length(direction);
        const bool usable = length > 0.0 && std::isfinite(length);
        const glm::vec3 unit = is_unit(direction) ? glm::vec3(tangent)
                               : usable           ? glm::vec3(direction / length)
                                                  : any_perpendicular(mesh.normals[v]);
        tangent = glm::vec4(unit, tangent.w < 0.0f ? -1.0f : 1.0f);
    }
}

}  // namespace kilolux
