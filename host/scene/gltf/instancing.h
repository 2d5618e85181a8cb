// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "host/scene/gltf/document.h"

namespace kilolux {

/// The transforms that EXT_mesh_gpu_instancing gives a node's mesh, below the node's own; none for
/// a node without it. Throws Error for attributes of unequal counts or of another type.
std::optional<std::vector<glm::dmat4>> node_from_instances(const GltfDocument& document,
                                                           std::size_t node);

}  // namespace kilolux
