// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>

#include "host/scene/gltf/nodes.h"

namespace kilolux {

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

}  // namespace kilolux
