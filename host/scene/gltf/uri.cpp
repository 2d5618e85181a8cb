// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/uri.h"

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

#include <cctype>
#include <charconv>
#include <fstream>
#include <limits>

#include "host/base/error.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBase64 =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

// The text with %XX replaced; a '%' that no two hex digits follow stands for itself.
std::string percent_decoded(const std::string& text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        unsigned value = 0;
        const char* digits = text.data() + i + 1;
        if (text[i] == '%' && i + 2 < text.size() &&
            std::from_chars(digits, digits + 2, value, 16).ptr == digits + 2) {
            out += static_cast<char>(value);
            i += 2;
        } else {
            out += text[i];
        }
    }
    return out;
}

Bytes decode_base64(std::string_view text, const std::string& where) {
    while (!text.empty() && text.back() == '=') text.remove_suffix(1);
    const std::size_t bad = text.find_first_not_of(kBase64);
    if (bad != std::string_view::npos || text.size() % 4 == 1) {
        throw Error(where + ": data URI holds broken base64 at its character " +
                    std::to_string(bad == std::string_view::npos ? text.size() : bad));
    }
    if (text.size() > std::numeric_limits<int>::max() / 2) {
        throw Error(where + ": data URI is larger than 1 GiB");
    }
    Bytes out;
    std::string mime_type;
    const std::string uri = "data:application/octet-stream;base64," + std::string(text);
    if (!text.empty() && !tinygltf::DecodeDataURI(&out, mime_type, uri, 0, false)) {
        throw Error(where + ": data URI holds broken base64");
    }
    return out;
}

Bytes read_data_uri(const std::string& uri, const std::string& where) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos) throw Error(where + ": data URI has no ','");
    const std::string_view header = std::string_view(uri).substr(0, comma);
    if (header.ends_with(";base64")) {
        return decode_base64(std::string_view(uri).substr(comma + 1), where);
    }
    const std::string decoded = percent_decoded(uri.substr(comma + 1));
    return {decoded.begin(), decoded.end()};
}

// "http:" and the like; one letter would be a drive of Windows, which a path check names better.
bool has_scheme(const std::string& uri) {
    const std::size_t colon = uri.find(':');
    if (colon == std::string::npos || colon < 2) return false;
    for (const char c : uri.substr(0, colon)) {
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '+' && c != '-' && c != '.') {
            return false;
        }
    }
    return true;
}

bool leaves_folder(const fs::path& path) {
    const fs::path normal = path.lexically_normal();
    return path.is_absolute() || (!normal.empty() && *normal.begin() == "..");
}

fs::path path_of_uri(const UriBase& base, const std::string& uri, const std::string& where) {
    if (has_scheme(uri)) {
        throw Error(where + ": uri '" + shown_uri(uri) + "' is neither a data URI nor a file path");
    }
    // Some writers do not encode: a name that exists as it stands is taken so.
    std::error_code ignored;
    fs::path relative = uri;
    if (leaves_folder(relative) || !fs::exists(base.folder / relative, ignored)) {
        relative = percent_decoded(uri);
    }
    if (relative.native().find('\0') != std::string::npos) {
        throw Error(where + ": uri '" + shown_uri(uri) + "' holds a zero byte");
    }
    if (leaves_folder(relative) && !base.allow_outside_paths) {
        throw Error(where + ": uri '" + shown_uri(uri) +
                    "' leaves the scene file's folder; allow it with --allow-outside-paths");
    }
    return base.folder / relative;
}

}  // namespace

std::string shown_uri(const std::string& uri) {
    constexpr std::size_t kLongest = 80;
    std::string shown = uri.substr(0, kLongest);
    for (char& c : shown) {
        if (std::iscntrl(static_cast<unsigned char>(c))) c = '?';
    }
    return uri.size() > kLongest ? shown + "..." : shown;
}

Bytes read_file_bytes(const fs::path& path, const std::string& where) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) {
        throw Error(where + ": " + (error ? "no such file" : "is not a regular file"));
    }
    Bytes bytes(fs::file_size(path));
    std::ifstream in(path, std::ios::binary);
    in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!in) throw Error(where + ": cannot be read");
    return bytes;
}

Bytes read_uri(const UriBase& base, const std::string& uri, const std::string& where) {
    const std::string place = base.file + ": " + where;
    if (uri.starts_with("data:")) return read_data_uri(uri, place);
    const fs::path path = path_of_uri(base, uri, place);
    return read_file_bytes(path, place + ": file '" + shown_uri(uri) + "'");
}

}  // namespace kilolux
