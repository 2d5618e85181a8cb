// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/gtc/quaternion.hpp>

#include "host/scene/gltf/document.h"

namespace kilolux {

/// KHR_node_visibility. Of a node and those above it the least counts.
enum class NodeVisibility {
    hidden,      // at all times
    hidden_now,  // an animation may show it
    visible,
};

/// A node's own transform, whether it is visible, and the morph weights that it gives its mesh.
struct NodePose {
    NodeVisibility visibility = NodeVisibility::visible;
    bool has_matrix = false;
    glm::dmat4 matrix{1.0};  // when it has one, instead of:
    glm::dvec3 translation{0.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 scale{1.0};
    std::vector<double> weights;
};

/// A zero rotation turns nothing.
glm::dmat4 matrix_of(const NodePose& pose);

/// The nodes of a file, placed.
struct PlacedNodes {
    std::vector<glm::dmat4> world_from_node;   // of every node of the file
    std::vector<std::vector<double>> weights;  // of every node; empty: the mesh's own
    std::vector<NodeVisibility> visibility;    // of every node
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

}  // namespace kilolux
