// SPDX-License-Identifier: Apache-2.0
#include "host/base/hash.h"
#include "host/scene/gltf/mesh/directions.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <unordered_map>

namespace kilolux {
namespace {

constexpr std::uint32_t kNoVertex = 0xffffffffu;

// Vertices with equal keys share a tangent. Compared by bits, with -0 made 0.
using VertexKey = std::array<float, 8>;

struct VertexKeyHash {
    std::size_t operator()(const VertexKey& key) const {
        return hash64(std::as_bytes(std::span(key)));
    }
};

enum Orientation : std::uint8_t { kPreserving = 0, kMirrored = 1, kUnknown = 2 };

struct TriangleFrame {
    Orientation orientation = kUnknown;
    glm::dvec3 tangent{0.0};  // unit, along growing u
};

// Sums of the tangents around a vertex, one per orientation.
using TangentSums = std::array<glm::dvec3, 2>;

std::vector<std::uint32_t> weld(const Mesh& mesh, const std::vector<glm::dvec2>& uvs) {
    std::unordered_map<VertexKey, std::uint32_t, VertexKeyHash> first;
    first.reserve(mesh.positions.size());
    std::vector<std::uint32_t> group(mesh.positions.size());
    for (std::size_t v = 0; v < group.size(); ++v) {
        const glm::vec3 p = mesh.positions[v] + 0.0f;
        const glm::vec3 n = mesh.normals[v] + 0.0f;
        const glm::vec2 uv = glm::vec2(uvs[v]) + 0.0f;
        group[v] = first
                       .try_emplace({p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y},
                                    static_cast<std::uint32_t>(v))
                       .first->second;
    }
    return group;
}

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

void add_triangle(const Mesh& mesh, const std::vector<std::uint32_t>& group, std::size_t triangle,
                  const TriangleFrame& frame, std::vector<TangentSums>& sums) {
    const std::uint32_t* corner = &mesh.indices[3 * triangle];
    for (std::size_t c = 0; c < 3; ++c) {
        const glm::dvec3 normal(mesh.normals[corner[c]]);
        const glm::dvec3 p(mesh.positions[corner[c]]);
        const glm::dvec3 to_next =
            in_plane(glm::dvec3(mesh.positions[corner[(c + 1) % 3]]) - p, normal);
        const glm::dvec3 to_last =
            in_plane(glm::dvec3(mesh.positions[corner[(c + 2) % 3]]) - p, normal);
        const double angle = std::acos(std::clamp(glm::dot(to_next, to_last), -1.0, 1.0));
        sums[group[corner[c]]][frame.orientation] += angle * in_plane(frame.tangent, normal);
    }
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
                                             const std::vector<TriangleFrame>& frames) {
    std::vector<Orientation> first(vertices, kUnknown);
    for (std::size_t i = 0; i < indices.size(); ++i) {
        if (first[indices[i]] == kUnknown) first[indices[i]] = frames[i / 3].orientation;
    }
    return first;
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
    std::vector<TriangleFrame> frames(indices.size() / 3);
    for (std::size_t t = 0; t < frames.size(); ++t) {
        frames[t].orientation = orientation_of(uvs, &indices[3 * t]);
    }
    const std::vector<Orientation> first = vertex_orientations(elements.size(), indices, frames);
    std::vector<std::uint32_t> copy_of(elements.size(), kNoVertex);
    for (std::size_t i = 0; i < indices.size(); ++i) {
        const std::uint32_t v = indices[i];
        const Orientation orientation = frames[i / 3].orientation;
        if (orientation == kUnknown || orientation == first[v]) continue;
        if (copy_of[v] == kNoVertex) {
            copy_of[v] = static_cast<std::uint32_t>(elements.size());
            elements.push_back(std::uint32_t{elements[v]});
        }
        indices[i] = copy_of[v];
    }
}

void derive_tangents(Mesh& mesh, const TextureUse& normal_texture) {
    const std::size_t vertices = mesh.positions.size();
    const std::vector<glm::dvec2> uvs = map_coordinates(
        mesh.texcoords[static_cast<std::size_t>(normal_texture.uv_set)], normal_texture, vertices);
    const std::vector<std::uint32_t> group = weld(mesh, uvs);
    std::vector<TangentSums> sums(vertices, TangentSums{});
    std::vector<TriangleFrame> frames(mesh.indices.size() / 3);
    for (std::size_t t = 0; t < frames.size(); ++t) {
        frames[t] = triangle_frame(mesh, uvs, t);
        if (frames[t].orientation != kUnknown) add_triangle(mesh, group, t, frames[t], sums);
    }
    const std::vector<Orientation> first = vertex_orientations(vertices, mesh.indices, frames);
    mesh.tangents.resize(vertices);
    for (std::size_t v = 0; v < vertices; ++v) {
        mesh.tangents[v] = tangent_of(mesh.normals[v], sums[group[v]], first[v]);
    }
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
