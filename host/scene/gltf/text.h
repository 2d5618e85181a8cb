// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "host/scene/gltf/uri.h"

namespace kilolux {

/// A glTF file taken out of its container.
struct GltfText {
    std::string json;
    Bytes binary;             // the GLB's BIN chunk
    bool has_binary = false;  // whether there was one
};

/// Reads a .gltf or .glb file; which one it is, its first bytes say. `name` starts the error
/// messages.
GltfText read_gltf_text(const std::filesystem::path& file, const std::string& name);

}  // namespace kilolux
