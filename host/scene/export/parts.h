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
    nlohmann::ordered_json roots = nlohmann::ordered_json::array();  // indices into `nodes`
    nlohmann::ordered_json lights = nlohmann::ordered_json::array();
    nlohmann::ordered_json cameras = nlohmann::ordered_json::array();
    std::size_t profile_lights = 0;  // in nodes, not in `lights`
    std::size_t unusable_lights = 0;
};

/// `mesh_of`: glTF's index of each mesh of the scene, -1 for those that are not written.
ExportedNodes export_nodes(const Scene& scene, const std::vector<int>& mesh_of);

/// Materials, textures and samplers as glTF arrays.
struct ExportedMaterials {
    nlohmann::ordered_json materials = nlohmann::ordered_json::array();
    nlohmann::ordered_json textures = nlohmann::ordered_json::array();
    nlohmann::ordered_json samplers = nlohmann::ordered_json::array();
};
ExportedMaterials export_materials(const Scene& scene);

/// The member at a path ("spot.innerConeAngle"); objects on the way are created.
nlohmann::ordered_json& at_path(nlohmann::ordered_json& object, std::string_view path);

/// An image as PNG, which keeps every bit. Throws Error with OpenImageIO's reason.
std::vector<unsigned char> encode_png(const Image& image);

/// The one buffer of a glTF file that is being written, with its views and accessors.
class ExportBuffer {
 public:
    /// Floats as an accessor of `components` per vertex (1: SCALAR, 2 to 4: VECn); its index.
    /// `bounded`: with the min and max that glTF requires of positions.
    int add_vertices(std::span<const float> values, int components, bool bounded = false);

    /// Triangle corners, in 16 bits where the largest index allows; the accessor's index.
    int add_indices(std::span<const std::uint32_t> indices);

    /// An embedded file; the buffer view's index.
    int add_bytes(std::span<const unsigned char> bytes);

    const std::vector<unsigned char>& bytes() const { return bytes_; }
    const nlohmann::ordered_json& views() const { return views_; }
    const nlohmann::ordered_json& accessors() const { return accessors_; }

 private:
    int add_accessor(nlohmann::ordered_json accessor);

    std::vector<unsigned char> bytes_;
    nlohmann::ordered_json views_ = nlohmann::ordered_json::array();
    nlohmann::ordered_json accessors_ = nlohmann::ordered_json::array();
};

}  // namespace kilolux
