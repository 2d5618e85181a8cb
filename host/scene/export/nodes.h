// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "host/scene/scene.h"

namespace kilolux {

/// Where things are: glTF's nodes with the lights and cameras they carry.
struct ExportedNodes {
    nlohmann::ordered_json nodes = nlohmann::ordered_json::array();
    nlohmann::ordered_json roots = nlohmann::ordered_json::array();  // indices into `nodes`
    nlohmann::ordered_json lights = nlohmann::ordered_json::array();
    nlohmann::ordered_json cameras = nlohmann::ordered_json::array();
    std::size_t unusable_lights = 0;
};

/// `mesh_of`: glTF's index of each mesh of the scene, -1 for those that are not written.
ExportedNodes export_nodes(const Scene& scene, const std::vector<int>& mesh_of);

}  // namespace kilolux
