// SPDX-License-Identifier: Apache-2.0
#include "host/scene/load_scene.h"

#include <map>

#include "host/scene/gltf_image.h"
#include "host/scene/gltf_lights_cameras.h"
#include "host/scene/gltf_material.h"
#include "host/scene/gltf_nodes.h"
#include "host/scene/gltf_parallel.h"
#include "host/scene/gltf_skin.h"

namespace kilolux {
namespace {

// A mesh of the file in one shape; nodes that do not deform it share it.
struct MeshShape {
    std::size_t mesh = 0;
    Deformation deformation;
};

// A shape put into the world.
struct Placement {
    std::size_t shape = 0;
    glm::dmat4 world_from_object{1.0};
};

struct MeshPlan {
    std::vector<MeshShape> shapes;
    std::vector<Placement> placements;
};

// One primitive of one shape.
struct PrimitiveJob {
    std::size_t shape = 0;
    std::size_t primitive = 0;
};

// Morph weights that a node's mesh stands with; empty when all are 0.
std::vector<double> morph_weights(const tinygltf::Mesh& mesh, const std::vector<double>& of_node) {
    const std::vector<double>& weights = of_node.empty() ? mesh.weights : of_node;
    for (const double weight : weights) {
        if (weight != 0.0) return weights;
    }
    return {};
}

MeshPlan plan_meshes(const GltfDocument& document, const PlacedNodes& nodes) {
    MeshPlan plan;
    std::map<int, std::size_t> undeformed;  // shape of the file's mesh
    for (const std::size_t n : nodes.in_scene) {
        const tinygltf::Node& node = document.model.nodes[n];
        if (node.mesh < 0) continue;
        const auto mesh = static_cast<std::size_t>(node.mesh);
        Placement placement{plan.shapes.size(), nodes.world_from_node[n]};
        MeshShape shape{mesh, {morph_weights(document.model.meshes[mesh], nodes.weights[n]), {}}};
        if (node.skin >= 0) {
            PlacedSkin skin = place_skin(document, static_cast<std::size_t>(node.skin), nodes);
            placement.world_from_object = skin.world_from_object;
            shape.deformation.object_from_bind = std::move(skin.object_from_bind);
        }
        if (!is_finite(placement.world_from_object)) {
            document.fail(node_name(document, n), "has a world transform that is not finite");
        }
        if (shape.deformation.empty()) {
            placement.shape = undeformed.try_emplace(node.mesh, placement.shape).first->second;
        }
        if (placement.shape == plan.shapes.size()) plan.shapes.push_back(std::move(shape));
        plan.placements.push_back(placement);
    }
    return plan;
}

std::vector<PrimitiveJob> list_jobs(const GltfDocument& document, const MeshPlan& plan) {
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

Mesh run_job(const GltfDocument& document, const GltfMaterials& materials, const MeshShape& shape,
             std::size_t primitive_index) {
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

void add_meshes(const GltfDocument& document, const GltfMaterials& materials,
                const PlacedNodes& nodes, Scene& scene) {
    const MeshPlan plan = plan_meshes(document, nodes);
    const std::vector<PrimitiveJob> jobs = list_jobs(document, plan);
    std::vector<Mesh> meshes(jobs.size());
    parallel_each(jobs.size(), [&](std::size_t j) {
        meshes[j] = run_job(document, materials, plan.shapes[jobs[j].shape], jobs[j].primitive);
    });
    std::vector<std::vector<int>> meshes_of_shape(plan.shapes.size());
    for (std::size_t j = 0; j < jobs.size(); ++j) {
        if (meshes[j].indices.empty()) continue;
        meshes_of_shape[jobs[j].shape].push_back(static_cast<int>(scene.meshes.size()));
        scene.meshes.push_back(std::move(meshes[j]));
    }
    std::size_t instance_count = 0;
    for (const Placement& placement : plan.placements) {
        instance_count += meshes_of_shape[placement.shape].size();
    }
    document.budget->charge(instance_count, sizeof(Instance), document.base.file + ": nodes");
    scene.instances.reserve(instance_count);
    for (const Placement& placement : plan.placements) {
        for (const int mesh : meshes_of_shape[placement.shape]) {
            scene.instances.push_back({mesh, placement.world_from_object});
        }
    }
}

}  // namespace

Scene load_scene(const std::filesystem::path& file, const LoadOptions& options) {
    const GltfDocument document = load_gltf_document(file, options);
    const PlacedNodes nodes = place_nodes(document);
    GltfMaterials materials = convert_materials(document);
    Scene scene;
    scene.name = file.stem().string();
    scene.lights = convert_lights(document, nodes);
    scene.cameras = convert_cameras(document, nodes);
    add_meshes(document, materials, nodes, scene);
    scene.images = decode_images(document, materials.images);
    scene.textures = std::move(materials.textures);
    scene.materials = std::move(materials.materials);
    return scene;
}

}  // namespace kilolux
