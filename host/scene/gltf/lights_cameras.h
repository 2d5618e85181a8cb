// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/gltf/nodes.h"

namespace kilolux {

/// Lights travel along their node's -Z, and X is their side; its scale does not matter here.
/// Returns false where X and Z are parallel or zero: the side is arbitrary then, and the direction
/// is 0 where Z is.
bool aim_light(SceneLight& light, const glm::dmat4& world_from_node);

/// The lights of kLightExtensions at their nodes. Unusable values are kept: the renderer rejects
/// and counts those lights.
std::vector<SceneLight> convert_lights(const GltfDocument& document, const PlacedNodes& nodes);

/// What the file says of the nodes that have lights, those of photometric webs, too; by nodes.
std::vector<LightNode> read_light_nodes(const GltfDocument& document);

/// Reports cones that KHR_lights_punctual does not allow, whose lights get the nearest ones, sizes
/// that are not above 0, and radii of lights that cannot have one.
void report_lights(const GltfDocument& document);

/// The cameras at their nodes, parents first. Throws Error for invalid values.
std::vector<SceneCamera> convert_cameras(const GltfDocument& document, const PlacedNodes& nodes);

}  // namespace kilolux
