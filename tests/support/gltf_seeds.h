// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tests/support/gltf_builder.h"

namespace kilolux {

/// Right files that together say everything that a glTF file may say: what mutations start from.
std::vector<GltfBuilder> gltf_seeds();

}  // namespace kilolux
