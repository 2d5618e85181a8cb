// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>

#include "host/scene/gltf/material/material.h"
#include "host/scene/gltf/nodes.h"

namespace kilolux {

/// Sets the properties in `poses` (one per node) that playing clips drive to their values at the
/// options' time.
///
/// Clips hold their first and last key outside of their range.
void apply_animations(const GltfDocument& document, std::vector<NodePose>& poses);

/// The same for what playing clips drive of materials, lights, cameras and the weights of meshes
/// (KHR_animation_pointer): sets them in the document.
void animate_elements(GltfDocument& document);

/// Whether a clip that plays drives materials.
bool drives_materials(const GltfDocument& document);

/// The materials with the least factors that playing clips give them, then those with the greatest.
/// Leaves the document with these: animate_elements() comes after it.
std::vector<Material> extreme_materials(GltfDocument& document);

/// Nodes whose morph weights a clip that plays drives.
std::set<int> nodes_with_driven_weights(const GltfDocument& document);

}  // namespace kilolux
