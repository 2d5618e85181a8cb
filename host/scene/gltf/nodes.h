// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <set>

#include "host/scene/gltf/document.h"

namespace kilolux {

/// A node's own transform, and the morph weights that it gives its mesh.
struct NodePose {
    bool has_matrix = false;
    glm::dmat4 matrix{1.0};  // when it has one, instead of:
    glm::dvec3 translation{0.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 scale{1.0};
    std::vector<double> weights;
};

/// A zero rotation turns nothing.
glm::dmat4 matrix_of(const NodePose& pose);

/// The transforms that EXT_mesh_gpu_instancing gives a node's mesh, below the node's own; none for
/// a node without it. Throws Error for attributes of unequal counts or of another type.
std::optional<std::vector<glm::dmat4>> node_from_instances(const GltfDocument& document,
                                                           std::size_t node);

/// The nodes of a file, placed.
struct PlacedNodes {
    std::vector<glm::dmat4> world_from_node;   // of every node of the file
    std::vector<std::vector<double>> weights;  // of every node; empty: the mesh's own
    std::vector<std::size_t> in_scene;         // nodes of the drawn scene, parents first
};

/// Evaluates the animations and multiplies the transforms down the hierarchy, in double.
///
/// The drawn scene is the file's default one, else its first; without scenes all nodes are drawn.
/// Throws Error for a node with two parents or that is its own ancestor.
PlacedNodes place_nodes(const GltfDocument& document);

/// "nodes[3] 'lamp'", for messages.
std::string node_name(const GltfDocument& document, std::size_t node);

bool is_finite(const glm::dmat4& matrix);

/// Sets the properties in `poses` (one per node) that playing clips drive to their values at the
/// options' time.
///
/// Clips hold their first and last key outside of their range. Where two drive the same property,
/// the first of GltfDocument::clips counts.
void apply_animations(const GltfDocument& document, std::vector<NodePose>& poses);

/// Whether a clip that plays drives a node.
bool has_animations(const GltfDocument& document);

/// Nodes whose morph weights a clip that plays drives.
std::set<int> nodes_with_driven_weights(const GltfDocument& document);

/// The lights of KHR_lights_punctual at their nodes. Unusable values are kept: the renderer rejects
/// and counts those lights.
std::vector<SceneLight> convert_lights(const GltfDocument& document, const PlacedNodes& nodes);

/// The IES files of EXT_lights_ies, in the file's order. Throws Error for one that cannot be used.
std::vector<PhotometricWeb> read_profiles(const GltfDocument& document);

/// Adds the lights of EXT_lights_ies at their nodes, with the scene's webs. Unusable values are
/// kept as above.
void add_profile_lights(const GltfDocument& document, const PlacedNodes& nodes, Scene& scene);

/// The cameras at their nodes, parents first. Throws Error for invalid values.
std::vector<SceneCamera> convert_cameras(const GltfDocument& document, const PlacedNodes& nodes);

}  // namespace kilolux
