// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "host/scene/export/parts.h"

namespace kilolux {

ExportedMaterials export_materials(const Scene& scene);

/// The member at a path ("spot.innerConeAngle"); objects on the way are created.
nlohmann::ordered_json& at_path(nlohmann::ordered_json& object, std::string_view path);

/// An image as PNG, which keeps every bit. Throws Error with OpenImageIO's reason.
std::vector<unsigned char> encode_png(const Image& image);

}  // namespace kilolux
