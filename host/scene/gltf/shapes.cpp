// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/shapes.h"

#include <map>

#include "host/scene/gltf/mesh/skin.h"
#include "host/scene/gltf/nodes.h"

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

}  // namespace

ShapePlan plan_shapes(const GltfDocument& document, const PlacedNodes& nodes) {
    ShapePlan plan;
    const std::set<int> morphing = nodes_with_driven_weights(document);
    std::map<int, std::size_t> undeformed;  // shape of the file's mesh
    for (const std::size_t n : nodes.in_scene) {
        const tinygltf::Node& node = document.model.nodes[n];
        if (node.mesh < 0) continue;
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
        if (!is_finite(placement.world_from_object)) {
            document.fail(node_name(document, n), "has a world transform that is not finite");
        }
        if (shape.deformation.empty() && !shape.moves) {
            placement.shape = undeformed.try_emplace(node.mesh, placement.shape).first->second;
        }
        if (placement.shape == plan.shapes.size()) plan.shapes.push_back(std::move(shape));
        plan.placements.push_back(placement);
    }
    return plan;
}

std::vector<PrimitiveJob> list_primitives(const GltfDocument& document, const ShapePlan& plan) {
    std::vector<PrimitiveJob> jobs;
    for (std::size_t s = 0; s < plan.shapes.size(); ++s) {
        const auto& primitives = document.model.meshes[plan.shapes[s].mesh].primitives;
        document.budget->charge(primitives.size(), sizeof(PrimitiveJob) + sizeof(Mesh),
                                document.base.file + ": meshes");
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            if (is_drawable(document, primitives[p])) jobs.push_back({s, p});
        }
    }
    return jobs;
}

Mesh build_primitive(const GltfDocument& document, const GltfMaterials& materials,
                     const MeshShape& shape, std::size_t primitive_index) {
    const tinygltf::Mesh& mesh = document.model.meshes[shape.mesh];
    const tinygltf::Primitive& primitive = mesh.primitives[primitive_index];
    const std::string where = document.base.file + ": " + element_name("meshes", shape.mesh) + "." +
                              element_name("primitives", primitive_index);
    const PrimitiveArrays arrays = open_primitive(document, primitive, where);
    Mesh out =
        build_mesh(document, arrays, shading_of(materials, primitive.material), shape.deformation);
    out.name = mesh.name;
    return out;
}

}  // namespace kilolux
