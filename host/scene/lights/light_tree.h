// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "host/scene/scene.h"
#include "kernels/shared/lights/light_tree.h"

namespace kilolux {

/// A binary tree over point lights, in preorder: 2 n - 1 nodes for n lights.
struct LightTree {
    std::vector<SceneLight> lights;  // a node's replacement for its lights: without a range
    std::vector<TreeNode> nodes;     // the same places
};

/// Whether a light of the scene goes into the tree: a point light without a range that has no
/// photometric web and follows no camera.
bool is_for_tree(const SceneLight& light);

/// The tree of these lights, which give light and are finite. Splits at the median of the longest
/// axis of their box; equal places keep their order.
LightTree make_light_tree(std::span<const SceneLight> lights);

}  // namespace kilolux
