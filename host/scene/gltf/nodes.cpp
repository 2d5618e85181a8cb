// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/nodes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "host/scene/gltf/animation.h"
#include "host/scene/gltf/extensions.h"

namespace kilolux {
namespace {

constexpr std::size_t kNoNode = static_cast<std::size_t>(-1);

NodePose rest_pose(const tinygltf::Node& node) {
    NodePose pose;
    pose.weights = node.weights;
    const auto* visibility = find_extension(node.extensions, "KHR_node_visibility");
    if (visibility != nullptr && !member_or(*visibility, "visible", true)) {
        pose.visibility = NodeVisibility::hidden;
    }
    if (!node.matrix.empty()) {
        pose.has_matrix = true;
        pose.matrix = glm::make_mat4(node.matrix.data());
        return pose;
    }
    if (!node.translation.empty()) pose.translation = glm::make_vec3(node.translation.data());
    if (!node.scale.empty()) pose.scale = glm::make_vec3(node.scale.data());
    if (const auto& q = node.rotation; !q.empty()) pose.rotation = {q[3], q[0], q[1], q[2]};
    return pose;
}

std::vector<std::size_t> find_parents(const GltfDocument& document) {
    const auto& nodes = document.model.nodes;
    std::vector<std::size_t> parents(nodes.size(), kNoNode);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        for (const int child : nodes[n].children) {
            std::size_t& parent = parents[static_cast<std::size_t>(child)];
            if (parent != kNoNode) {
                document.fail(node_name(document, static_cast<std::size_t>(child)),
                              "is a child of both nodes[{}] and nodes[{}]", parent, n);
            }
            parent = n;
        }
    }
    return parents;
}

// Nodes reached from `roots` in depth-first order, each once, parents first.
std::vector<std::size_t> walk(const GltfDocument& document, const std::vector<std::size_t>& roots) {
    std::vector<bool> seen(document.model.nodes.size(), false);
    std::vector<std::size_t> order;
    std::vector<std::size_t> stack(roots.rbegin(), roots.rend());
    while (!stack.empty()) {
        const std::size_t node = stack.back();
        stack.pop_back();
        if (seen[node]) continue;
        seen[node] = true;
        order.push_back(node);
        const auto& children = document.model.nodes[node].children;
        for (auto child = children.rbegin(); child != children.rend(); ++child) {
            stack.push_back(static_cast<std::size_t>(*child));
        }
    }
    return order;
}

std::vector<std::size_t> scene_roots(const GltfDocument& document,
                                     const std::vector<std::size_t>& all_roots) {
    const tinygltf::Model& model = document.model;
    if (model.scenes.empty()) return all_roots;
    const auto scene = static_cast<std::size_t>(std::max(model.defaultScene, 0));
    const auto& nodes = model.scenes[scene].nodes;
    return {nodes.begin(), nodes.end()};
}

void check_acyclic(const GltfDocument& document, const std::vector<std::size_t>& reached) {
    if (reached.size() == document.model.nodes.size()) return;
    std::vector<bool> seen(document.model.nodes.size(), false);
    for (const std::size_t node : reached) seen[node] = true;
    const auto lost = std::find(seen.begin(), seen.end(), false);
    document.fail(node_name(document, static_cast<std::size_t>(lost - seen.begin())),
                  "hangs on a cycle of nodes");
}

}  // namespace

glm::dmat4 matrix_of(const NodePose& pose) {
    if (pose.has_matrix) return pose.matrix;
    const double length = glm::length(pose.rotation);
    const bool usable = length > 0.0 && std::isfinite(length);
    const glm::dquat rotation = usable ? pose.rotation / length : glm::dquat(1.0, 0.0, 0.0, 0.0);
    return glm::translate(glm::dmat4(1.0), pose.translation) * glm::mat4_cast(rotation) *
           glm::scale(glm::dmat4(1.0), pose.scale);
}

std::string node_name(const GltfDocument& document, std::size_t node) {
    const std::string& name = document.model.nodes[node].name;
    return element_name("nodes", node) + (name.empty() ? "" : " '" + shown_uri(name) + "'");
}

bool is_finite(const glm::dmat4& matrix) {
    const double* values = &matrix[0][0];
    return std::all_of(values, values + 16, [](double value) { return std::isfinite(value); });
}

PlacedNodes place_nodes(const GltfDocument& document) {
    const auto& nodes = document.model.nodes;
    const std::vector<std::size_t> parents = find_parents(document);
    std::vector<std::size_t> roots;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        if (parents[n] == kNoNode) roots.push_back(n);
    }
    const std::vector<std::size_t> order = walk(document, roots);
    check_acyclic(document, order);
    std::vector<NodePose> poses;
    poses.reserve(nodes.size());
    for (const tinygltf::Node& node : nodes) poses.push_back(rest_pose(node));
    apply_animations(document, poses);
    PlacedNodes out;
    out.world_from_node.resize(nodes.size());
    out.visibility.resize(nodes.size());
    for (const std::size_t n : order) {
        const glm::dmat4 own = matrix_of(poses[n]);
        const bool is_root = parents[n] == kNoNode;
        out.world_from_node[n] = is_root ? own : out.world_from_node[parents[n]] * own;
        out.visibility[n] = is_root ? poses[n].visibility
                                    : std::min(poses[n].visibility, out.visibility[parents[n]]);
    }
    for (NodePose& pose : poses) out.weights.push_back(std::move(pose.weights));
    out.in_scene = walk(document, scene_roots(document, roots));
    return out;
}

}  // namespace kilolux
