// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/mesh/tangents.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <unordered_map>

#include "host/base/hash.h"
#include "host/scene/gltf/mesh/normals.h"

namespace kilolux {
namespace {

constexpr std::uint32_t kNoVertex = 0xffffffffu;

constexpr std::size_t kVerticesOfTask = 1024;

// By vertex, the first one with an equal key. Keys are arrays of floats with -0 made 0, or of
// integers.
template <typename KeyOf>
std::vector<std::uint32_t> first_of_equal(std::size_t vertices, const KeyOf& key_of) {
    using Key = decltype(key_of(std::size_t{}));
    const auto hash = [](const Key& key) { return hash64(std::as_bytes(std::span(key))); };
    std::unordered_map<Key, std::uint32_t, decltype(hash)> first(vertices, hash);
    std::vector<std::uint32_t> group(vertices);
    for (std::size_t v = 0; v < vertices; ++v) {
        group[v] = first.try_emplace(key_of(v), static_cast<std::uint32_t>(v)).first->second;
    }
    return group;
}

enum Orientation : std::uint8_t { kPreserving = 0, kMirrored = 1, kUnknown = 2 };

struct TriangleFrame {
    Orientation orientation = kUnknown;
    glm::dvec3 tangent{0.0};  // unit, along growing u
};

// Sums of the tangents around a vertex, one per orientation.
using TangentSums = std::array<glm::dvec3, 2>;

// Twice the triangle's signed area in texture space.
double uv_area(std::span<const glm::dvec2> uvs, const std::uint32_t* corner) {
    const glm::dvec2 d1 = uvs[corner[1]] - uvs[corner[0]];
    const glm::dvec2 d2 = uvs[corner[2]] - uvs[corner[0]];
    return d1.x * d2.y - d1.y * d2.x;
}

// By texture coordinates alone, so that animated positions do not change it.
Orientation orientation_of(std::span<const glm::dvec2> uvs, const std::uint32_t* corner) {
    const double area = uv_area(uvs, corner);
    if (area == 0.0 || !std::isfinite(area)) return kUnknown;
    return area > 0.0 ? kPreserving : kMirrored;
}

TriangleFrame triangle_frame(const Mesh& mesh, const std::vector<glm::dvec2>& uvs,
                             std::size_t triangle) {
    const std::uint32_t* corner = &mesh.indices[3 * triangle];
    TriangleFrame frame{orientation_of(uvs, corner)};
    if (frame.orientation == kUnknown) return frame;
    const glm::dvec3 p0(mesh.positions[corner[0]]);
    const glm::dvec3 e1 = glm::dvec3(mesh.positions[corner[1]]) - p0;
    const glm::dvec3 e2 = glm::dvec3(mesh.positions[corner[2]]) - p0;
    const glm::dvec2 d1 = uvs[corner[1]] - uvs[corner[0]];
    const glm::dvec2 d2 = uvs[corner[2]] - uvs[corner[0]];
    const double sign = frame.orientation == kPreserving ? 1.0 : -1.0;
    const glm::dvec3 along_u = (e1 * d2.y - e2 * d1.y) * sign;
    const double length = glm::length(along_u);
    if (length > 0.0 && std::isfinite(length)) frame.tangent = along_u / length;
    return frame;
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

template <typename Work>
void parallel_range(std::size_t first, std::size_t end, const Work& work) {
    using Range = tbb::blocked_range<std::size_t>;
    tbb::parallel_for(Range(first, end, kVerticesOfTask), [&](const Range& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) work(i);
    });
}

// Adds triangles in their order, so that threads change no bit; parts bound the memory.
std::vector<TangentSums> sum_tangents(const Mesh& mesh, const std::vector<glm::dvec2>& uvs,
                                      const std::vector<std::uint32_t>& groups,
                                      std::vector<Orientation>& orientations) {
    constexpr std::size_t kPart = 16384;
    const std::size_t triangles = orientations.size();
    std::vector<TangentSums> sums(mesh.positions.size(), TangentSums{});
    std::vector<std::array<glm::dvec3, 3>> part(std::min(kPart, triangles));
    for (std::size_t begin = 0; begin < triangles; begin += kPart) {
        const std::size_t end = std::min(begin + kPart, triangles);
        parallel_range(begin, end, [&](std::size_t t) {
            const TriangleFrame frame = triangle_frame(mesh, uvs, t);
            orientations[t] = frame.orientation;
            if (frame.orientation != kUnknown) {
                part[t - begin] = corner_tangents(mesh, t, frame.tangent);
            }
        });
        for (std::size_t t = begin; t < end; ++t) {
            if (orientations[t] == kUnknown) continue;
            for (std::size_t c = 0; c < 3; ++c) {
                sums[groups[mesh.indices[3 * t + c]]][orientations[t]] += part[t - begin][c];
            }
        }
    }
    return sums;
}

glm::vec4 tangent_of(const glm::vec3& normal, const TangentSums& sums, Orientation orientation) {
    if (orientation == kUnknown) {
        orientation = glm::length(sums[kPreserving]) >= glm::length(sums[kMirrored]) ? kPreserving
                                                                                     : kMirrored;
    }
    const glm::dvec3 sum = in_plane(sums[orientation], glm::dvec3(normal));
    const bool usable = glm::dot(sum, sum) > 0.0;
    // v grows downwards in glTF's images: where u and v preserve orientation, up is -cross(n, t).
    const float w = usable && orientation == kPreserving ? -1.0f : 1.0f;
    return usable ? glm::vec4(glm::vec3(sum), w) : glm::vec4(any_perpendicular(normal), w);
}

// The orientation of each vertex's first triangle that has an orientation.
std::vector<Orientation> vertex_orientations(std::size_t vertices,
                                             std::span<const std::uint32_t> indices,
                                             const std::vector<Orientation>& triangles) {
    std::vector<Orientation> first(vertices, kUnknown);
    for (std::size_t i = 0; i < indices.size(); ++i) {
        if (first[indices[i]] == kUnknown) first[indices[i]] = triangles[i / 3];
    }
    return first;
}

std::vector<glm::dvec2> coordinates_of(const Mesh& mesh, const TextureUse& use) {
    return map_coordinates(mesh.texcoords[static_cast<std::size_t>(use.uv_set)], use,
                           mesh.positions.size());
}

}  // namespace

std::vector<glm::dvec2> map_coordinates(std::span<const glm::vec2> texcoords, const TextureUse& use,
                                        std::size_t vertices) {
    const glm::dmat3 uv_from_texcoord(use.uv_from_texcoord);
    std::vector<glm::dvec2> uvs(vertices, glm::dvec2(0.0));
    for (std::size_t v = 0; v < texcoords.size(); ++v) {
        uvs[v] = glm::dvec2(uv_from_texcoord * glm::dvec3(glm::dvec2(texcoords[v]), 1.0));
    }
    return uvs;
}

void split_mirrored(std::span<const glm::dvec2> uvs, std::vector<std::uint32_t>& elements,
                    std::vector<std::uint32_t>& indices) {
    std::vector<Orientation> triangles(indices.size() / 3);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        triangles[t] = orientation_of(uvs, &indices[3 * t]);
    }
    const std::vector<Orientation> first = vertex_orientations(elements.size(), indices, triangles);
    std::vector<std::uint32_t> copy_of(elements.size(), kNoVertex);
    for (std::size_t i = 0; i < indices.size(); ++i) {
        const std::uint32_t v = indices[i];
        const Orientation orientation = triangles[i / 3];
        if (orientation == kUnknown || orientation == first[v]) continue;
        if (copy_of[v] == kNoVertex) {
            copy_of[v] = static_cast<std::uint32_t>(elements.size());
            elements.push_back(std::uint32_t{elements[v]});
        }
        indices[i] = copy_of[v];
    }
}

std::vector<std::uint32_t> equal_vertices(const Mesh& mesh, const TextureUse& normal_texture) {
    const std::vector<glm::dvec2> uvs = coordinates_of(mesh, normal_texture);
    return first_of_equal(mesh.positions.size(), [&](std::size_t v) {
        const glm::vec3 p = mesh.positions[v] + 0.0f;
        const glm::vec3 n = mesh.normals[v] + 0.0f;
        const glm::vec2 uv = glm::vec2(uvs[v]) + 0.0f;
        return std::array{p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y};
    });
}

void split_groups(std::vector<std::uint32_t>& groups, std::span<const glm::vec4> values) {
    groups = first_of_equal(groups.size(), [&](std::size_t v) {
        const auto bits = std::bit_cast<std::array<std::uint32_t, 4>>(values[v] + 0.0f);
        return std::array{groups[v], bits[0], bits[1], bits[2], bits[3]};
    });
}

void derive_tangents(Mesh& mesh, const TextureUse& normal_texture,
                     const std::vector<std::uint32_t>& groups) {
    const std::vector<glm::dvec2> uvs = coordinates_of(mesh, normal_texture);
    std::vector<Orientation> triangles(mesh.indices.size() / 3);
    const std::vector<TangentSums> sums = sum_tangents(mesh, uvs, groups, triangles);
    const std::vector<Orientation> first =
        vertex_orientations(mesh.positions.size(), mesh.indices, triangles);
    mesh.tangents.resize(mesh.positions.size());
    parallel_range(0, mesh.positions.size(), [&](std::size_t v) {
        mesh.tangents[v] = tangent_of(mesh.normals[v], sums[groups[v]], first[v]);
    });
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
