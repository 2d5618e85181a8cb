// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/mesh/solids.h"

#include <cmath>
#include <numbers>

#include "host/scene/gltf/mesh/normals.h"

namespace kilolux {
namespace {

constexpr std::size_t kVertices = 6;   // of either solid
constexpr std::size_t kTriangles = 8;  // of either solid

// Faces look outwards. A prism's vertices are 0 to 2 around the segment's begin, 3 to 5 around its
// end; an octahedron's are +x, -x, +y, -y, +z, -z.
constexpr std::array<std::array<std::uint32_t, 3>, kTriangles> kPrism = {
    {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}, {3, 4, 5}, {0, 2, 1}}};
constexpr std::array<std::array<std::uint32_t, 3>, kTriangles> kOctahedron = {
    {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};

// Adds solids whose vertices are copies of a mesh's, moved.
class SolidBuilder {
 public:
    SolidBuilder(const Mesh& from, std::size_t count) : from_(from) {
        out_.name = from.name;
        out_.material = from.material;
        out_.revision = from.revision;
        const std::size_t vertices = count * kVertices;
        out_.positions.reserve(vertices);
        out_.normals.reserve(vertices);
        if (!from.tangents.empty()) out_.tangents.reserve(vertices);
        if (!from.colors.empty()) out_.colors.reserve(vertices);
        for (std::size_t set = 0; set < 2; ++set) {
            if (!from.texcoords[set].empty()) out_.texcoords[set].reserve(vertices);
        }
        out_.indices.reserve(count * kTriangles * 3);
    }

    // A vertex at `radius` from vertex `v`, in a direction of length 1.
    void add_vertex(std::uint32_t v, const glm::dvec3& direction, double radius) {
        out_.positions.emplace_back(glm::dvec3(from_.positions[v]) + radius * direction);
        out_.normals.push_back(from_.normals.empty() ? glm::vec3(direction) : from_.normals[v]);
        if (!from_.tangents.empty()) out_.tangents.push_back(from_.tangents[v]);
        if (!from_.colors.empty()) out_.colors.push_back(from_.colors[v]);
        for (std::size_t set = 0; set < 2; ++set) {
            if (!from_.texcoords[set].empty())
                out_.texcoords[set].push_back(from_.texcoords[set][v]);
        }
    }

    // The triangles of the last six vertices.
    void add_faces(const std::array<std::array<std::uint32_t, 3>, kTriangles>& faces) {
        const auto first = static_cast<std::uint32_t>(out_.positions.size() - kVertices);
        for (const auto& face : faces) {
            for (const std::uint32_t corner : face) out_.indices.push_back(first + corner);
        }
    }

    Mesh take() { return std::move(out_); }

 private:
    const Mesh& from_;
    Mesh out_;
};

void add_octahedron(SolidBuilder& solids, std::uint32_t vertex, double width) {
    const double radius = width / std::sqrt(std::numbers::sqrt3);  // surface 4 sqrt(3) r^2
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        for (const double sign : {1.0, -1.0}) {
            glm::dvec3 direction(0.0);
            direction[axis] = sign;
            solids.add_vertex(vertex, direction, radius);
        }
    }
    solids.add_faces(kOctahedron);
}

void add_prism(SolidBuilder& solids, const Mesh& mesh, std::uint32_t begin, std::uint32_t end,
               double width) {
    const double radius = width * std::numbers::pi / (3.0 * std::numbers::sqrt3);
    const glm::dvec3 way = glm::dvec3(mesh.positions[end]) - glm::dvec3(mesh.positions[begin]);
    const double length = glm::length(way);
    const glm::dvec3 along = length > 0.0 ? way / length : glm::dvec3(1.0, 0.0, 0.0);
    const glm::dvec3 right(any_perpendicular(glm::vec3(along)));
    const glm::dvec3 up = glm::cross(along, right);
    for (const std::uint32_t vertex : {begin, end}) {
        for (int corner = 0; corner < 3; ++corner) {
            const double angle = corner * 2.0 * std::numbers::pi / 3.0;
            solids.add_vertex(vertex, right * std::cos(angle) + up * std::sin(angle), radius);
        }
    }
    solids.add_faces(kPrism);
}

}  // namespace

void make_solids(Mesh& mesh, int corners, double width) {
    SolidBuilder solids(mesh, mesh.indices.size() / static_cast<std::size_t>(corners));
    if (corners == 1) {
        for (const std::uint32_t vertex : mesh.indices) add_octahedron(solids, vertex, width);
    } else {
        for (std::size_t i = 0; i + 1 < mesh.indices.size(); i += 2) {
            add_prism(solids, mesh, mesh.indices[i], mesh.indices[i + 1], width);
        }
    }
    mesh = solids.take();
}

std::uint64_t solid_bytes() {
    constexpr std::uint64_t kVertexBytes =
        2 * sizeof(glm::vec3) + 2 * sizeof(glm::vec4) + 2 * sizeof(glm::vec2);
    return kVertices * kVertexBytes + kTriangles * 3 * sizeof(std::uint32_t);
}

}  // namespace kilolux
