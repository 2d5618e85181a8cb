// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "host/scene/scene.h"

namespace kilolux {

struct LoadOptions {
    double time = 0.0;                 // [s] at which the file's animations are evaluated
    bool allow_outside_paths = false;  // URIs that leave the scene file's folder
};

/// Reads a glTF 2.0 file (.gltf or .glb) with its buffers and images.
///
/// Instances hold world transforms; meshes are triangle lists with normals, and tangents where a
/// normal map needs them. Throws Error with file, place and value seen for anything broken or
/// required and unsupported; names what is optional and unsupported once in a warning.
Scene load_scene(const std::filesystem::path& file, const LoadOptions& options = {});

}  // namespace kilolux
