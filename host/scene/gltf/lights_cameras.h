// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/gltf/nodes.h"

namespace kilolux {

/// The lights of KHR_lights_punctual at their nodes. Odd values are kept: who lights with them
/// rejects and counts them.
std::vector<SceneLight> convert_lights(const GltfDocument& document, const PlacedNodes& nodes);

/// The cameras at their nodes, in the order of the walk. Throws Error for values that no camera
/// has.
std::vector<SceneCamera> convert_cameras(const GltfDocument& document, const PlacedNodes& nodes);

}  // namespace kilolux
