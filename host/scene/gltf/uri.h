// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace kilolux {

using Bytes = std::vector<unsigned char>;

/// Where a scene file's URIs start from.
struct UriBase {
    std::string file;  // the scene file, as error messages name it
    std::filesystem::path folder;
    bool allow_outside_paths = false;  // URIs may leave `folder`
};

/// Bytes of a regular file. `where` begins the error message.
Bytes read_file_bytes(const std::filesystem::path& path, const std::string& where);

/// Bytes behind a URI of the scene file: a data URI, or a file by its percent-encoded relative
/// path.
///
/// Throws Error that starts with "<base.file>: <where>: " when the URI is of another scheme, leaves
/// the folder without permission, names no regular file, or holds broken base64.
Bytes read_uri(const UriBase& base, const std::string& uri, const std::string& where);

/// A URI as an error message may show it: data URIs cut short.
std::string shown_uri(const std::string& uri);

}  // namespace kilolux
