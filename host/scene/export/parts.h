// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "host/scene/scene.h"

namespace kilolux {

/// glTF's nodes with the lights and cameras they carry.
struct ExportedNodes {
    nlohmann::ordered_json nodes = nlohmann::ordered_json::array();
    nlohmann::ordered_json roots = nlohmann::ordered_json::array();    // indices into `nodes`
    nlohmann::ordered_json lights = nlohmann::ordered_json::object();  // by extension, without IES
    nlohmann::ordered_json cameras = nlohmann::ordered_json::array();
    std::size_t usable_lights = 0, unusable_lights = 0;
};

/// Materials, textures and samplers as glTF arrays.
struct ExportedMaterials {
    nlohmann::ordered_json materials = nlohmann::ordered_json::array();
    nlohmann::ordered_json textures = nlohmann::ordered_json::array();
    nlohmann::ordered_json samplers = nlohmann::ordered_json::array();
};

}  // namespace kilolux
