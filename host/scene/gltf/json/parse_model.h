// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/gltf/document.h"

namespace kilolux {

/// Sets the document's model, materials and lights from JSON that is checked. `charged`: what the
/// budget holds for the JSON [byte]; what the document keeps of it stays charged, and what the
/// model takes is charged ahead.
void parse_model(GltfDocument& document, nlohmann::json root, std::uint64_t charged);

}  // namespace kilolux
