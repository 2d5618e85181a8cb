// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "host/scene/scene.h"

namespace kilolux {

/// Materials, textures and samplers as glTF arrays; adds the names of the extensions they use.
struct ExportedMaterials {
    nlohmann::ordered_json materials = nlohmann::ordered_json::array();
    nlohmann::ordered_json textures = nlohmann::ordered_json::array();
    nlohmann::ordered_json samplers = nlohmann::ordered_json::array();
};
ExportedMaterials export_materials(const Scene& scene, std::set<std::string>& extensions);

/// An image as PNG, which keeps every bit. Throws Error with OpenImageIO's reason.
std::vector<unsigned char> encode_png(const Image& image);

}  // namespace kilolux
