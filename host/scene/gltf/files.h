// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kilolux {

using Bytes = std::vector<unsigned char>;
using ByteSpan = std::span<const unsigned char>;

/// Called with the size of what is read or decoded before memory is taken for it; may throw.
using BeforeBytes = std::function<void(std::uint64_t bytes)>;

/// A glTF file and the parts of its container.
struct GltfText {
    Bytes file;  // what the others point into
    std::string_view json;
    ByteSpan binary;          // the GLB's BIN chunk
    bool has_binary = false;  // whether there was one
};

/// Reads a .gltf or .glb file, recognised by its first bytes. `name` starts the error messages.
GltfText read_gltf_text(
    const std::filesystem::path& file, const std::string& name,
    const BeforeBytes& before = [](std::uint64_t) {});

/// The JSON of a .gltf or .glb file, and nothing else of it. Throws Error.
Bytes read_gltf_json(const std::filesystem::path& file, const BeforeBytes& before);

/// The folder and the name that a scene file's URIs are relative to.
struct UriBase {
    std::string file;  // the scene file, as error messages name it
    std::filesystem::path folder;
    bool allow_outside_paths = false;  // URIs and links may leave `folder`
};

/// The path within the scene file's folder that a URI names. Some writers do not encode URIs: a
/// file with the undecoded name is preferred. ".." removes the name before it, whether that exists
/// or not. May lead out of the folder, and need not exist.
std::filesystem::path relative_path_of(const std::filesystem::path& folder, const std::string& uri);

/// Bytes of a data URI, or of a file named by its percent-encoded path relative to the scene file.
///
/// Throws Error that starts with "<base.file>: <where>: " when the URI has another scheme, leaves
/// the folder without permission (also through a symbolic link), names no regular file, or holds
/// broken base64.
Bytes read_uri(const UriBase& base, const std::string& uri, const std::string& where,
               const BeforeBytes& before);

/// Whether a URI holds its data; schemes are compared without regard to case.
bool is_data_uri(std::string_view uri);

/// The text with %XX replaced; a '%' that no two hex digits follow stands for itself.
std::string percent_decoded(const std::string& text);

/// A URI or another text of the file as an error message may show it: short and without control
/// characters.
std::string shown_uri(const std::string& uri);

}  // namespace kilolux
