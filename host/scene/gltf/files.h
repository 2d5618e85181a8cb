// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace kilolux {

using Bytes = std::vector<unsigned char>;

/// A glTF file taken out of its container.
struct GltfText {
    std::string json;
    Bytes binary;             // the GLB's BIN chunk
    bool has_binary = false;  // whether there was one
};

/// Reads a .gltf or .glb file, told apart by its first bytes. `name` starts the error messages.
GltfText read_gltf_text(const std::filesystem::path& file, const std::string& name);

/// What a scene file's URIs are relative to.
struct UriBase {
    std::string file;  // the scene file, as error messages name it
    std::filesystem::path folder;
    bool allow_outside_paths = false;  // URIs and links may leave `folder`
};

/// Bytes of a data URI, or of a file named by its percent-encoded path relative to the scene file.
///
/// Throws Error that starts with "<base.file>: <where>: " when the URI has another scheme, leaves
/// the folder without permission (also through a symbolic link), names no regular file, or holds
/// broken base64.
Bytes read_uri(const UriBase& base, const std::string& uri, const std::string& where);

/// The text with %XX replaced; a '%' that no two hex digits follow stands for itself.
std::string percent_decoded(const std::string& text);

/// A URI or another text of the file as an error message may show it: short and without control
/// characters.
std::string shown_uri(const std::string& uri);

}  // namespace kilolux
