// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>

#include "host/scene/gltf/nodes.h"

namespace kilolux {

/// Replaces what the file's animations drive in `poses` (one per node) by its value at the
/// time that the options give.
///
/// All animations play at once and hold their first and last key outside of their range; where two
/// drive the same property, the first one in the file does.
void apply_animations(const GltfDocument& document, std::vector<NodePose>& poses);

/// Whether any animation of the file drives a node.
bool has_animations(const GltfDocument& document);

/// Nodes whose morph weights an animation drives.
std::set<int> nodes_with_driven_weights(const GltfDocument& document);

}  // namespace kilolux
