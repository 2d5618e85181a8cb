// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/export/parts.h"

namespace kilolux {

/// `mesh_of`: glTF's index of each mesh of the scene, -1 for those that are not written.
ExportedNodes export_nodes(const Scene& scene, const std::vector<int>& mesh_of);

}  // namespace kilolux
