// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/mesh/mesh.h"

#include <cmath>
#include <limits>
#include <numeric>

#include "host/scene/gltf/mesh/normals.h"
#include "host/scene/gltf/mesh/skin.h"
#include "host/scene/gltf/mesh/solids.h"
#include "host/scene/gltf/mesh/tangents.h"

namespace kilolux {
namespace {

void plan_unshared(MeshPlan& plan) {
    plan.elements = plan.arrays.corners;
    plan.indices.resize(plan.elements.size());
    std::iota(plan.indices.begin(), plan.indices.end(), 0u);
}

// The used vertices in their order: some exporters share one accessor among many primitives.
void plan_used(MeshPlan& plan) {
    const PrimitiveArrays& arrays = plan.arrays;
    std::vector<std::uint32_t> vertex_of(arrays.vertex_count, 0);
    for (const std::uint32_t corner : arrays.corners) vertex_of[corner] = 1;
    for (std::size_t element = 0; element < vertex_of.size(); ++element) {
        if (vertex_of[element] == 0) continue;
        vertex_of[element] = static_cast<std::uint32_t>(plan.elements.size());
        plan.elements.push_back(static_cast<std::uint32_t>(element));
    }
    plan.indices.reserve(arrays.corners.size());
    for (const std::uint32_t corner : arrays.corners) plan.indices.push_back(vertex_of[corner]);
}

// Reads attributes for all vertices of a plan, with the morph targets that have a weight.
struct AttributeReader {
    const MeshPlan& plan;
    std::span<const double> weights;

    using Components = std::initializer_list<std::size_t>;

    // Empty when the primitive lacks the attribute. `normalized`: also where the file lacks the
    // flag.
    template <typename Vector>
    std::vector<Vector> read(const std::string& name, Components allowed,
                             bool normalized = false) const {
        const PrimitiveArrays& arrays = plan.arrays;
        const auto found = arrays.attributes.find(name);
        if (found == arrays.attributes.end()) return {};
        ElementArray base = found->second;
        expect_components(base, allowed, name);
        base.normalized = base.normalized || normalized;
        std::vector<std::pair<float, const ElementArray*>> deltas;
        for (std::size_t t = 0; t < std::min(weights.size(), arrays.targets.size()); ++t) {
            const auto delta = arrays.targets[t].find(name);
            if (weights[t] == 0.0 || delta == arrays.targets[t].end()) continue;
            deltas.emplace_back(to_float(weights[t]), &delta->second);
        }
        std::vector<Vector> out;
        out.reserve(plan.elements.size());
        for (const std::uint32_t element : plan.elements) {
            glm::vec4 value = read_vector(base, element);
            for (const auto& [weight, delta] : deltas)
                value += weight * read_vector(*delta, element);
            out.emplace_back(value);
        }
        return out;
    }
};

void check_positions(const std::string& where, const Mesh& mesh, const char* when) {
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const glm::vec3& p = mesh.positions[v];
        if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
        throw Error(fmt::format("{}: vertex {} is not finite once {}", where, v, when));
    }
}

std::string texcoord_name(const MeshShading& shading, std::size_t set) {
    return fmt::format("TEXCOORD_{}", shading.texcoord_sets[set]);
}

// A file's tangents are valid only with the file's normals (glTF 2.0, section 3.7.2.1).
bool has_tangents(const AttributeArrays& attributes) {
    return attributes.contains("NORMAL") && attributes.contains("TANGENT");
}

// Splits vertices by the file's texture coordinates where tangents will be derived from them.
void split_for_tangents(const MeshShading& shading, MeshPlan& plan) {
    const TextureUse& map = *shading.tangent_map;
    const auto texcoords = AttributeReader{plan, {}}.read<glm::vec2>(
        texcoord_name(shading, static_cast<std::size_t>(map.uv_set)), {2});
    split_mirrored(map_coordinates(texcoords, map, plan.elements.size()), plan.elements,
                   plan.indices);
}

void read_attributes(Mesh& mesh, const AttributeReader& reader, const MeshShading& shading) {
    const AttributeArrays& attributes = reader.plan.arrays.attributes;
    mesh.positions = reader.read<glm::vec3>("POSITION", {3});
    mesh.normals = reader.read<glm::vec3>("NORMAL", {3});
    // Integers are normalized (glTF 2.0, section 3.7.2.1); some writers leave out the flag.
    mesh.colors = reader.read<glm::vec4>("COLOR_0", {3, 4}, true);
    for (glm::vec4& color : mesh.colors) {
        if (attributes.at("COLOR_0").components == 3) color.w = 1.0f;
        color = glm::clamp(color, 0.0f, 1.0f);  // glTF 2.0, section 3.7.2.1; after morphing, too
    }
    for (std::size_t set = 0; set < 2; ++set) {
        mesh.texcoords[set] = reader.read<glm::vec2>(texcoord_name(shading, set), {2});
    }
    if (shading.tangent_map && has_tangents(attributes)) {
        mesh.tangents = reader.read<glm::vec4>("TANGENT", {4});
    }
}

void finish_normals(Mesh& mesh) {
    mesh.normals.empty() ? derive_flat_normals(mesh) : mend_normals(mesh);
}

// Tangents where the material needs them.
void finish_tangents(Mesh& mesh, const MeshShading& shading,
                     const std::vector<std::uint32_t>& groups) {
    if (!shading.tangent_map) return;
    const TextureUse& map = *shading.tangent_map;
    if (!mesh.tangents.empty()) {
        mend_tangents(mesh);
        return;
    }
    derive_tangents(mesh, map, groups.empty() ? equal_vertices(mesh, map) : groups);
}

// Groups the vertices that are equal in the file and that weights and joints keep equal.
std::vector<std::uint32_t> lasting_groups(const MeshPlan& plan, const MeshShading& shading) {
    Mesh rest;
    read_attributes(rest, {plan, {}}, shading);
    rest.indices = plan.indices;
    finish_normals(rest);
    std::vector<std::uint32_t> groups = equal_vertices(rest, *shading.tangent_map);
    std::vector<glm::vec4> values(groups.size());
    const auto split_by = [&](const ElementArray& array) {
        for (std::size_t v = 0; v < values.size(); ++v) {
            values[v] = read_vector(array, plan.elements[v]);
        }
        split_groups(groups, values);
    };
    for (const auto& [name, array] : plan.arrays.attributes) {
        if (name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_")) split_by(array);
    }
    for (const AttributeArrays& target : plan.arrays.targets) {
        for (const auto& [name, array] : target) split_by(array);
    }
    return groups;
}

// What rounding positions of 64 bits to floats may take of a mesh's size.
constexpr double kStatedRounding = 1e-6;

void report_rounding(const GltfDocument& document, const MeshPlan& plan) {
    const ElementArray& positions = plan.arrays.attributes.at("POSITION");
    if (positions.component_type != TINYGLTF_COMPONENT_TYPE_DOUBLE) return;
    Box box;
    double lost = 0.0;
    for (const std::uint32_t element : plan.elements) {
        const glm::dvec3 p(read_exact(positions, element));
        box.add(p);
        lost = std::max(lost, glm::length(p - glm::dvec3(glm::vec3(p))));
    }
    if (box.empty() || lost <= kStatedRounding * glm::length(box.size())) return;
    document.leave_out(
        fmt::format("a mesh's positions of 64 bits lose {:.1g} m as floats: its node's translation "
                    "would keep what is far from the origin",
                    lost));
}

constexpr std::size_t kMaxSolids = std::numeric_limits<std::uint32_t>::max() / 6;  // 6 vertices

}  // namespace

MeshPlan plan_mesh(const GltfDocument& document, PrimitiveArrays arrays, const MeshShading& shading,
                   bool moves) {
    constexpr std::uint64_t kVertexBytes = 2 * (sizeof(glm::vec3) * 2 + sizeof(glm::vec4) * 2 +
                                                sizeof(glm::vec2) * 2);  // room to split
    const bool is_surface = arrays.corners_each == 3;
    const bool shares_vertices = !is_surface || arrays.attributes.contains("NORMAL");
    document.budget->charge(arrays.corners.size(), 4 * sizeof(std::uint32_t), arrays.where);
    if (shares_vertices) document.budget->charge(arrays.vertex_count, 4, arrays.where);
    MeshPlan plan{std::move(arrays), {}, {}, {}};
    shares_vertices ? plan_used(plan) : plan_unshared(plan);
    plan.arrays.corners = {};
    document.budget->charge(plan.elements.size(), kVertexBytes, plan.arrays.where);
    report_rounding(document, plan);
    const bool derives_tangents =
        is_surface && shading.tangent_map && !has_tangents(plan.arrays.attributes);
    if (!derives_tangents) return plan;
    if (shares_vertices) split_for_tangents(shading, plan);
    if (moves) plan.tangent_groups = lasting_groups(plan, shading);
    return plan;
}

Mesh build_mesh(const MeshPlan& plan, const MeshShading& shading, const Deformation& deformation) {
    Mesh mesh;
    mesh.material = shading.material;
    read_attributes(mesh, {plan, deformation.weights}, shading);
    mesh.indices = plan.indices;
    if (!deformation.object_from_bind.empty()) {
        skin_mesh(mesh, plan.arrays, plan.elements, deformation.object_from_bind);
    }
    check_positions(plan.arrays.where, mesh, "morph targets and skin are applied");
    if (plan.arrays.corners_each != 3) return mesh;
    finish_normals(mesh);
    finish_tangents(mesh, shading, plan.tangent_groups);
    return mesh;
}

void make_solid_mesh(const GltfDocument& document, Mesh& mesh, const SolidSize& size) {
    const std::size_t count = mesh.indices.size() / static_cast<std::size_t>(size.corners);
    const std::string where = document.base.file + ": points and lines";
    if (count > kMaxSolids) {
        throw Error(
            fmt::format("{}: a primitive has {}, more than {} solids", where, count, kMaxSolids));
    }
    document.budget->charge(count, solid_bytes(), where);
    make_solids(mesh, size.corners, size.width);
    check_positions(where, mesh, "they have a width");
    mend_normals(mesh);
    if (!mesh.tangents.empty()) mend_tangents(mesh);
}

}  // namespace kilolux
