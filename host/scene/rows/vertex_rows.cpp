// SPDX-License-Identifier: Apache-2.0
#include "host/scene/rows/vertex_rows.h"

#include <fmt/format.h>
#include <algorithm>
#include <glm/gtc/type_ptr.hpp>
#include <limits>

#include "host/base/error.h"

namespace kilolux {
namespace {

// Of length 1; zero where there is no direction.
glm::vec3 direction_of(const glm::vec3& v) {
    const double length = glm::length(glm::dvec3(v));
    return length > 0.0 ? glm::vec3(glm::dvec3(v) / length) : glm::vec3(0.0f);
}

template <typename Vector>
std::vector<Vector> with_unit_directions(std::vector<Vector> vectors) {
    for (Vector& v : vectors) {
        const glm::vec3 unit = direction_of(glm::vec3(v));
        v.x = unit.x;
        v.y = unit.y;
        v.z = unit.z;
    }
    return vectors;
}

// Copies an attribute to its place in every row.
template <typename Vector>
void place(const std::vector<Vector>& values, uint at, std::size_t row_floats, float* rows) {
    if (at == SURFACE_ABSENT) return;
    for (std::size_t i = 0; i < values.size(); ++i) {
        std::copy_n(glm::value_ptr(values[i]), Vector::length(), rows + i * row_floats + at);
    }
}

}  // namespace

MeshRow vertex_layout(const Mesh& mesh, const SurfaceFeatures& features) {
    MeshRow row{};
    uint floats = 3;
    const auto attribute = [&](bool wanted, uint size) {
        if (!wanted) return SURFACE_ABSENT;
        floats += size;
        return floats - size;
    };
    row.normal = attribute(!features.coverage && !mesh.normals.empty(), 3);
    row.tangent = attribute(features.tangents && !mesh.tangents.empty(), 4);
    row.texcoord0 = attribute(features.texcoord0 && !mesh.texcoords[0].empty(), 2);
    row.texcoord1 = attribute(features.texcoord1 && !mesh.texcoords[1].empty(), 2);
    row.color = attribute(features.vertex_color && !mesh.colors.empty(), 4);
    row.vertex_floats = floats;
    return row;
}

std::size_t vertex_floats(const Mesh& mesh, const SurfaceFeatures& features) {
    return vertex_layout(mesh, features).vertex_floats;
}

void append_vertices(const Mesh& mesh, const MeshRow& row, std::vector<float>& out) {
    const std::size_t first = out.size();
    const std::size_t floats = row.vertex_floats;
    out.resize(first + mesh.positions.size() * floats);
    float* rows = out.data() + first;
    place(mesh.positions, 0, floats, rows);
    place(with_unit_directions(mesh.normals), row.normal, floats, rows);
    place(with_unit_directions(mesh.tangents), row.tangent, floats, rows);
    place(mesh.texcoords[0], row.texcoord0, floats, rows);
    place(mesh.texcoords[1], row.texcoord1, floats, rows);
    place(mesh.colors, row.color, floats, rows);
}

uint checked_count(std::size_t count, const Scene& scene) {
    if (count <= std::numeric_limits<uint>::max()) return static_cast<uint>(count);
    throw Error(fmt::format(
        "scene '{}': {} numbers of vertices, triangles or texels; kernels address 4294967295",
        scene.name, count));
}

}  // namespace kilolux
