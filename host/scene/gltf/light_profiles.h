// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/gltf/nodes.h"

namespace kilolux {

/// The photometric files of EXT_lights_ies, in the file's order. Throws Error for one that cannot
/// be used.
std::vector<PhotometricWeb> read_profiles(const GltfDocument& document);

/// Adds the lights of EXT_lights_ies at their nodes, with the scene's webs. Unusable values are
/// kept: the renderer rejects and counts those lights.
void add_profile_lights(const GltfDocument& document, const PlacedNodes& nodes, Scene& scene);

}  // namespace kilolux
