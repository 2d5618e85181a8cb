// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/shapes.h"

#include <cmath>
#include <map>
#include <tuple>

#include "host/scene/gltf/animation.h"
#include "host/scene/gltf/instancing.h"
#include "host/scene/gltf/mesh/skin.h"
#include "host/scene/material_table.h"

namespace kilolux {
namespace {

// Morph weights of a node's mesh; empty when all are 0.
std::vector<double> morph_weights(const tinygltf::Mesh& mesh, const std::vector<double>& of_node) {
    const std::vector<double>& weights = of_node.empty() ? mesh.weights : of_node;
    for (const double weight : weights) {
        if (weight != 0.0) return weights;
    }
    return {};
}

// Cube root of the factor on volumes; 1 where there is none.
double mean_scale(const glm::dmat4& world_from_object) {
    const double scale = std::cbrt(std::abs(glm::determinant(glm::dmat3(world_from_object))));
    return scale > 0.0 && std::isfinite(scale) ? scale : 1.0;
}

// The placements of a node: one, or those that instancing gives its mesh. A node that is hidden for
// a while keeps them, as points: renderers know all instances from the start.
void add_placements(const GltfDocument& document, std::size_t node, const Placement& placement,
                    bool is_hidden, ShapePlan& plan) {
    const std::size_t first = plan.placements.size();
    const auto instances = node_from_instances(document, node);
    if (instances && document.model.nodes[node].skin >= 0) {
        document.leave_out("instancing of nodes that have a skin is left out");
        plan.placements.push_back(placement);
    } else if (instances) {
        document.budget->charge(instances->size(), sizeof(Placement),
                                document.base.file + ": nodes");
        for (const glm::dmat4& node_from_instance : *instances) {
            plan.placements.push_back(
                {placement.shape, placement.world_from_object * node_from_instance});
        }
    } else {
        plan.placements.push_back(placement);
    }
    for (std::size_t p = first; p < plan.placements.size(); ++p) {
        glm::dmat4& world_from_object = plan.placements[p].world_from_object;
        if (!is_finite(world_from_object)) {
            document.fail(node_name(document, node), "has a world transform that is not finite");
        }
        if (is_hidden) world_from_object = glm::dmat4(glm::dmat3(0.0));
    }
}

}  // namespace

ShapePlan plan_shapes(const GltfDocument& document, const PlacedNodes& nodes) {
    ShapePlan plan;
    const std::set<int> morphing = nodes_with_driven_weights(document);
    // Shapes that nodes share: by the file's mesh, its skin and its weights.
    std::map<std::tuple<int, int, std::vector<double>>, std::size_t> shared;
    for (const std::size_t n : nodes.in_scene) {
        const tinygltf::Node& node = document.model.nodes[n];
        if (node.mesh < 0 || nodes.visibility[n] == NodeVisibility::hidden) continue;
        const auto mesh = static_cast<std::size_t>(node.mesh);
        Placement placement{plan.shapes.size(), nodes.world_from_node[n]};
        MeshShape shape{mesh,
                        {morph_weights(document.model.meshes[mesh], nodes.weights[n]), {}},
                        morphing.contains(static_cast<int>(n))};
        if (node.skin >= 0) {
            PlacedSkin skin = place_skin(document, static_cast<std::size_t>(node.skin), nodes);
            placement.world_from_object = skin.world_from_object;
            shape.deformation.object_from_bind = std::move(skin.object_from_bind);
            shape.moves = true;
        }
        if (!morphing.contains(static_cast<int>(n))) {
            placement.shape =
                shared
                    .try_emplace({node.mesh, node.skin, shape.deformation.weights}, placement.shape)
                    .first->second;
        }
        if (placement.shape == plan.shapes.size()) {
            shape.metres_per_unit = mean_scale(placement.world_from_object);
            plan.shapes.push_back(std::move(shape));
        }
        add_placements(document, n, placement, nodes.visibility[n] != NodeVisibility::visible,
                       plan);
    }
    return plan;
}

void add_map_axes(const GltfDocument& document, const GltfMaterials& materials,
                  const std::vector<Material>& extremes, ShapePlan& plan) {
    const auto axes = [](const TextureUse& use) { return glm::mat2(use.uv_from_texcoord); };
    const std::size_t count = extremes.size() / 2;
    for (MeshShape& shape : plan.shapes) {
        for (const auto& primitive : document.model.meshes[shape.mesh].primitives) {
            const MeshShading shading = shading_of(materials, primitive);
            if (!shading.tangent_map) continue;
            const auto index = static_cast<std::size_t>(shading.material);
            shape.map_axes.push_back(axes(*shading.tangent_map));
            shape.moves |=
                axes(tangent_map(extremes[index])) != axes(tangent_map(extremes[count + index]));
        }
    }
}

std::vector<PrimitiveJob> list_primitives(const GltfDocument& document, const ShapePlan& plan) {
    std::vector<PrimitiveJob> jobs;
    for (std::size_t s = 0; s < plan.shapes.size(); ++s) {
        const auto& primitives = document.model.meshes[plan.shapes[s].mesh].primitives;
        document.budget->charge(primitives.size(), sizeof(PrimitiveJob) + sizeof(Mesh),
                                document.base.file + ": meshes");
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            if (!is_drawable(document, primitives[p])) continue;
            jobs.push_back({s, p, corners_of(primitives[p])});
        }
    }
    return jobs;
}

double line_width_m(const GltfDocument& document, const ShapePlan& plan,
                    const std::vector<PrimitiveJob>& jobs, const std::vector<Mesh>& meshes) {
    const LineWidth& width = document.options.line_width;
    if (width.metres) return width.value;
    std::vector<Box> boxes(plan.shapes.size());
    for (std::size_t j = 0; j < jobs.size(); ++j) {
        for (const glm::vec3& p : meshes[j].positions) boxes[jobs[j].shape].add(glm::dvec3(p));
    }
    Box box;
    for (const Placement& placement : plan.placements) {
        const Box& own = boxes[placement.shape];
        if (own.empty()) continue;
        for (std::size_t i = 0; i < 8; ++i) {
            box.add(glm::dvec3(placement.world_from_object * glm::dvec4(own.corner(i), 1.0)));
        }
    }
    const double diagonal = box.empty() ? 0.0 : glm::length(box.size());
    return width.value * (diagonal > 0.0 ? diagonal : 1.0);
}

MeshPlan plan_primitive(const GltfDocument& document, const GltfMaterials& materials,
                        const MeshShape& shape, std::size_t primitive_index) {
    const std::string where = document.base.file + ": " + element_name("meshes", shape.mesh) + "." +
                              element_name("primitives", primitive_index);
    const auto& primitive = document.model.meshes[shape.mesh].primitives[primitive_index];
    return plan_mesh(document, open_primitive(document, primitive, where),
                     shading_of(materials, primitive), shape.moves);
}

Mesh build_primitive(const GltfDocument& document, const GltfMaterials& materials,
                     const MeshShape& shape, std::size_t primitive, const MeshPlan& plan) {
    const tinygltf::Mesh& mesh = document.model.meshes[shape.mesh];
    const MeshShading shading = shading_of(materials, mesh.primitives[primitive]);
    Mesh out = build_mesh(plan, shading, shape.deformation);
    out.name = mesh.name;
    return out;
}

}  // namespace kilolux
