// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host/scene/scene.h"

namespace kilolux {

/// One file of an exported scene.
struct ExportedFile {
    std::string name;  // relative to the scene file's folder
    std::vector<unsigned char> bytes;
};

/// A scene as glTF 2.0.
struct ExportedScene {
    std::vector<ExportedFile> files;  // the scene file comes last, after those that it refers to
    std::size_t lights = 0;           // written
    // Left out: glTF allows no infinite or negative value of a light, and has no triangles.
    std::size_t unusable_lights = 0;
};

/// Writes the scene as glTF 2.0 that load_scene() reads back to the same picture.
///
/// `file` names the result: .glb holds all in itself; .gltf has its buffer beside it as <stem>.bin
/// and its images as <stem>_<n>.png. Lights are KHR_lights_punctual with their ranges, or
/// EXT_lights_area; what these lack is among a light's extras (range, two sides, the aspect of an
/// ellipse, a point's radius). A light without a range stays so. Lights of emissive surfaces are
/// not written, for the surfaces are; other triangles are left out. Emission beyond 1 is
/// KHR_materials_emissive_strength. Numbers come back exactly, except the rotation of a texture
/// transform and the transform of an instance that shears (two nodes then), which come back within
/// their rounding. Throws Error when a .glb would be larger than its 4 GiB.
ExportedScene export_scene(const Scene& scene, const std::filesystem::path& file);

}  // namespace kilolux
