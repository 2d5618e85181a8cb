// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/mesh/mesh.h"

#include <cmath>
#include <numeric>

#include "host/scene/gltf/mesh/directions.h"
#include "host/scene/gltf/mesh/skin.h"

namespace kilolux {
namespace {

// Which element of the attributes each vertex of the mesh takes, and its triangles.
struct VertexPlan {
    std::vector<std::uint32_t> elements;
    std::vector<std::uint32_t> indices;
};

// An attribute with the morph targets that have a weight.
struct MorphedArray {
    const ElementArray* base = nullptr;
    std::vector<std::pair<float, const ElementArray*>> deltas;
};

VertexPlan plan_unshared(const PrimitiveArrays& arrays) {
    VertexPlan plan{arrays.corners, std::vector<std::uint32_t>(arrays.corners.size())};
    std::iota(plan.indices.begin(), plan.indices.end(), 0u);
    return plan;
}

// The used vertices in their order: some exporters share one accessor among many primitives.
VertexPlan plan_used(const PrimitiveArrays& arrays) {
    VertexPlan plan;
    std::vector<std::uint32_t> vertex_of(arrays.vertex_count, 0);
    for (const std::uint32_t corner : arrays.corners) vertex_of[corner] = 1;
    for (std::size_t element = 0; element < vertex_of.size(); ++element) {
        if (vertex_of[element] == 0) continue;
        vertex_of[element] = static_cast<std::uint32_t>(plan.elements.size());
        plan.elements.push_back(static_cast<std::uint32_t>(element));
    }
    plan.indices.reserve(arrays.corners.size());
    for (const std::uint32_t corner : arrays.corners) plan.indices.push_back(vertex_of[corner]);
    return plan;
}

MorphedArray find_array(const PrimitiveArrays& arrays, const std::string& name,
                        const std::vector<double>& weights) {
    MorphedArray out;
    const auto found = arrays.attributes.find(name);
    if (found == arrays.attributes.end()) return out;
    out.base = &found->second;
    for (std::size_t t = 0; t < std::min(weights.size(), arrays.targets.size()); ++t) {
        const auto delta = arrays.targets[t].find(name);
        if (weights[t] == 0.0 || delta == arrays.targets[t].end()) continue;
        out.deltas.emplace_back(to_float(weights[t]), &delta->second);
    }
    return out;
}

glm::vec4 read_morphed(const MorphedArray& array, std::size_t element) {
    glm::vec4 value = read_vector(*array.base, element);
    for (const auto& [weight, delta] : array.deltas) value += weight * read_vector(*delta, element);
    return value;
}

// An attribute for all vertices of the plan; empty when the primitive lacks it.
template <typename Vector>
std::vector<Vector> read_attribute(const MorphedArray& array, const VertexPlan& plan) {
    std::vector<Vector> out;
    if (array.base == nullptr) return out;
    out.reserve(plan.elements.size());
    for (const std::uint32_t element : plan.elements) {
        out.emplace_back(read_morphed(array, element));
    }
    return out;
}

std::vector<glm::vec4> read_colors(const PrimitiveArrays& arrays, const VertexPlan& plan,
                                   const std::vector<double>& weights) {
    MorphedArray array = find_array(arrays, "COLOR_0", weights);
    if (array.base == nullptr) return {};
    expect_components(*array.base, {3, 4}, "COLOR_0");
    ElementArray colors = *array.base;
    // Integers are normalized (glTF 2.0, section 3.7.2.1); some writers leave out the flag.
    colors.normalized = true;
    array.base = &colors;
    auto out = read_attribute<glm::vec4>(array, plan);
    for (glm::vec4& color : out) {
        if (colors.components == 3) color.w = 1.0f;
        color = glm::max(color, glm::vec4(0.0f));
    }
    return out;
}

void check_positions(const PrimitiveArrays& arrays, const Mesh& mesh) {
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const glm::vec3& p = mesh.positions[v];
        if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
        throw Error(
            fmt::format("{}: vertex {} is not finite once morph targets and skin are applied",
                        arrays.where, v));
    }
}

void read_tangents(Mesh& mesh, const MorphedArray& array, const VertexPlan& plan) {
    if (array.base == nullptr) return;
    expect_components(*array.base, {4}, "TANGENT");
    mesh.tangents = read_attribute<glm::vec4>(array, plan);
}

void read_attributes(Mesh& mesh, const PrimitiveArrays& arrays, const MeshShading& shading,
                     const VertexPlan& plan, const std::vector<double>& weights) {
    const MorphedArray positions = find_array(arrays, "POSITION", weights);
    const MorphedArray normals = find_array(arrays, "NORMAL", weights);
    expect_components(*positions.base, {3}, "POSITION");
    mesh.positions = read_attribute<glm::vec3>(positions, plan);
    if (normals.base != nullptr) expect_components(*normals.base, {3}, "NORMAL");
    mesh.normals = read_attribute<glm::vec3>(normals, plan);
    mesh.colors = read_colors(arrays, plan, weights);
    for (std::size_t set = 0; set < 2; ++set) {
        const std::string name = fmt::format("TEXCOORD_{}", shading.texcoord_sets[set]);
        const MorphedArray array = find_array(arrays, name, weights);
        if (array.base != nullptr) expect_components(*array.base, {2}, name);
        mesh.texcoords[set] = read_attribute<glm::vec2>(array, plan);
    }
    // Tangents of a file hold only beside the normals of the file (glTF 2.0, section 3.7.2.1).
    if (shading.normal_texture.present() && normals.base != nullptr) {
        read_tangents(mesh, find_array(arrays, "TANGENT", weights), plan);
    }
}

}  // namespace

Mesh build_mesh(const GltfDocument& document, const PrimitiveArrays& arrays,
                const MeshShading& shading, const Deformation& deformation) {
    constexpr std::uint64_t kVertexBytes = 2 * (sizeof(glm::vec3) * 2 + sizeof(glm::vec4) * 2 +
                                                sizeof(glm::vec2) * 2);  // room to split
    const bool has_normals = arrays.attributes.contains("NORMAL");
    document.budget->charge(arrays.corners.size(), 4 * sizeof(std::uint32_t), arrays.where);
    if (has_normals) document.budget->charge(arrays.vertex_count, 4, arrays.where);
    VertexPlan plan = has_normals ? plan_used(arrays) : plan_unshared(arrays);
    document.budget->charge(plan.elements.size(), kVertexBytes, arrays.where);
    Mesh mesh;
    mesh.material = shading.material;
    read_attributes(mesh, arrays, shading, plan, deformation.weights);
    mesh.indices = std::move(plan.indices);
    if (!deformation.object_from_bind.empty()) {
        skin_mesh(mesh, arrays, plan.elements, deformation.object_from_bind);
    }
    check_positions(arrays, mesh);
    has_normals ? mend_normals(mesh) : derive_flat_normals(mesh);
    if (!shading.normal_texture.present()) return mesh;
    mesh.tangents.empty() ? derive_tangents(mesh, shading.normal_texture) : mend_tangents(mesh);
    return mesh;
}

}  // namespace kilolux
