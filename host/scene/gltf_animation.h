// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/gltf_nodes.h"

namespace kilolux {

/// Replaces what the file's animations drive in `poses` (one per node) by its value at the
/// time that the options give.
///
/// All animations play at once and hold their first and last key outside of their range; where two
/// drive the same property, the first one in the file does.
void apply_animations(const GltfDocument& document, std::vector<NodePose>& poses);

}  // namespace kilolux
