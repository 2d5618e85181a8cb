// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/files.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>
#include <fstream>
#include <optional>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/text.h"
#include "host/scene/gltf/json/json_text.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

// glTF 2.0 specification, section 4.4 (binary glTF layout); all little-endian.
constexpr std::uint32_t kMagic = 0x46546C67;      // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004E4942;   // "BIN\0"
constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;
constexpr std::size_t kFirstBytes = kHeaderBytes + kChunkHeaderBytes;  // up to the JSON

std::uint32_t read_u32(ByteSpan bytes, std::size_t offset) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

// The chunk at `offset`; throws when its claimed length does not fit.
ByteSpan chunk_at(ByteSpan bytes, std::size_t offset, const std::string& name) {
    const std::size_t length = read_u32(bytes, offset);
    const std::size_t left = bytes.size() - offset - kChunkHeaderBytes;
    if (length > left) {
        throw Error(fmt::format("{}: GLB chunk at byte {} claims {} bytes, the file holds {}", name,
                                offset, length, left));
    }
    return bytes.subspan(offset + kChunkHeaderBytes, length);
}

bool header_fits(ByteSpan bytes, std::size_t offset) {
    return offset + kChunkHeaderBytes <= bytes.size() &&
           read_u32(bytes, offset) <= bytes.size() - offset - kChunkHeaderBytes;
}

// Where the chunk behind `chunk` begins. Chunks are padded to 4 bytes, and the padding counts
// (section 4.4.3). Some writers do not pad the JSON, or do not count it: the next header is then
// sought at both places, a BIN chunk's first.
std::size_t next_chunk(ByteSpan bytes, std::size_t offset, ByteSpan chunk,
                       const std::string& name) {
    const std::size_t end = offset + kChunkHeaderBytes + chunk.size();
    if (chunk.size() % 4 == 0 || end == bytes.size()) return end;
    const std::string what =
        fmt::format("{}: the GLB's {}chunk at byte {} has {} bytes, which is no multiple of 4",
                    name, offset == kHeaderBytes ? "JSON " : "", offset, chunk.size());
    const std::size_t padded = (end + 3) / 4 * 4;
    if (padded >= bytes.size()) return bytes.size();
    const auto begins_bin = [&](std::size_t place) {
        return header_fits(bytes, place) && read_u32(bytes, place + 4) == kBinChunk;
    };
    for (const std::size_t place : {end, padded}) {
        if (!begins_bin(place)) continue;
        warn(what + (place == end ? "; read by its length" : "; read as padded"));
        return place;
    }
    if (header_fits(bytes, padded)) return padded;
    throw Error(what +
                ", and no chunk follows it: a chunk is padded to 4 bytes (JSON by spaces), "
                "and its length counts the padding");
}

std::string_view as_text(ByteSpan bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

struct GlbHeader {
    std::uint32_t length = 0;       // of the GLB
    std::uint32_t json_length = 0;  // as claimed
};

// From the first bytes of a file of `size`; none if it is no GLB.
std::optional<GlbHeader> read_glb_header(ByteSpan bytes, std::uint64_t size,
                                         const std::string& name) {
    if (bytes.size() < sizeof(kMagic) || read_u32(bytes, 0) != kMagic) return std::nullopt;
    if (bytes.size() < kFirstBytes) {
        throw Error(fmt::format("{}: GLB of {} bytes is shorter than its headers", name, size));
    }
    if (const std::uint32_t version = read_u32(bytes, 4); version != 2) {
        throw Error(fmt::format("{}: GLB version is {}, must be 2", name, version));
    }
    const GlbHeader out{read_u32(bytes, 8), read_u32(bytes, kHeaderBytes)};
    if (out.length > size || out.length < kFirstBytes) {
        throw Error(fmt::format("{}: GLB header claims {} bytes, the file holds {}", name,
                                out.length, size));
    }
    if (read_u32(bytes, kHeaderBytes + 4) != kJsonChunk) {
        throw Error(name + ": the first chunk of the GLB is not JSON");
    }
    return out;
}

// Sets the parts of a GLB from its bytes, whose header has been read.
void split_glb(GltfText& out, std::size_t length, const std::string& name) {
    const ByteSpan bytes = ByteSpan(out.file).first(length);
    const auto text = chunk_at(bytes, kHeaderBytes, name);
    out.json = as_text(text);
    std::size_t offset = next_chunk(bytes, kHeaderBytes, text, name);
    // Chunks of other types may stand anywhere after the first and are skipped (section 4.4.3.1).
    while (!out.has_binary && offset + kChunkHeaderBytes <= bytes.size()) {
        const auto chunk = chunk_at(bytes, offset, name);
        if (read_u32(bytes, offset + 4) == kBinChunk) {
            out.has_binary = true;
            out.binary = chunk;
        }
        offset = next_chunk(bytes, offset, chunk, name);
    }
}

// The size of a regular file. `where` starts the error message.
std::uint64_t size_of_file(const fs::path& path, const std::string& where) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) {
        throw Error(where + ": " + (error ? "no such file" : "is not a regular file"));
    }
    const std::uint64_t size = fs::file_size(path, error);
    if (error) throw Error(where + ": cannot be read: " + error.message());
    return size;
}

// The next bytes of a file.
Bytes read_next(std::ifstream& in, std::uint64_t size, const std::string& where) {
    Bytes bytes(size);
    in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!in) throw Error(where + ": cannot be read");
    return bytes;
}

// Bytes of a regular file.
Bytes read_file_bytes(const fs::path& path, const std::string& where, const BeforeBytes& before) {
    const std::uint64_t size = size_of_file(path, where);
    before(size);
    std::ifstream in(path, std::ios::binary);
    return read_next(in, size, where);
}

Bytes decode_base64_uri(std::string_view text, const std::string& where,
                        const BeforeBytes& before) {
    before(text.size() / 4 * 3 + 3);
    Bytes out(text.size() / 4 * 3 + 3);
    try {
        out.resize(decode_base64(text, out.data()));
    } catch (const Error& error) {
        throw Error(where + ": data URI " + error.what());
    }
    return out;
}

Bytes read_data_uri(const std::string& uri, const std::string& where, const BeforeBytes& before) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos) throw Error(where + ": data URI has no ','");
    if (lower(uri.substr(0, comma)).ends_with(";base64")) {
        return decode_base64_uri(std::string_view(uri).substr(comma + 1), where, before);
    }
    before(uri.size());
    const std::string decoded = percent_decoded(uri.substr(comma + 1));
    return {decoded.begin(), decoded.end()};
}

// "http:" and the like. One letter is a drive of Windows, which the check of paths refuses.
bool has_scheme(const std::string& uri) {
    const std::size_t colon = uri.find(':');
    if (colon == std::string::npos || colon < 2) return false;
    return std::all_of(uri.begin(), uri.begin() + static_cast<std::ptrdiff_t>(colon), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '+' || c == '-' || c == '.';
    });
}

bool leaves_folder(const fs::path& path) {
    const fs::path normal = path.lexically_normal();
    return path.is_absolute() || (!normal.empty() && *normal.begin() == "..");
}

// Whether a symbolic link on the way to the file leads out of the folder.
bool links_out_of_folder(const fs::path& folder, const fs::path& relative) {
    std::error_code error;
    const fs::path root = fs::canonical(folder.empty() ? "." : folder, error);
    const fs::path target = fs::weakly_canonical(root / relative, error);
    // A path that cannot be resolved cannot be read either; reading has the better message.
    return !error && leaves_folder(target.lexically_relative(root));
}

}  // namespace

fs::path relative_path_of(const fs::path& folder, const std::string& uri) {
    std::error_code ignored;
    fs::path undecoded = fs::path(uri).lexically_normal();
    if (!leaves_folder(undecoded) && fs::exists(folder / undecoded, ignored)) return undecoded;
    return fs::path(percent_decoded(uri)).lexically_normal();
}

namespace {

fs::path path_of_uri(const UriBase& base, const std::string& uri, const std::string& where) {
    if (has_scheme(uri)) {
        throw Error(where + ": uri '" + shown_uri(uri) + "' is neither a data URI nor a file path");
    }
    const fs::path relative = relative_path_of(base.folder, uri);
    if (relative.native().find('\0') != std::string::npos) {
        throw Error(where + ": uri '" + shown_uri(uri) + "' holds a zero byte");
    }
    if (!base.allow_outside_paths &&
        (leaves_folder(relative) || links_out_of_folder(base.folder, relative))) {
        throw Error(where + ": uri '" + shown_uri(uri) +
                    "' leaves the scene file's folder; allow it with --allow-outside-paths");
    }
    return base.folder / relative;
}

}  // namespace

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

std::string shown_uri(const std::string& uri) {
    constexpr std::size_t kLongest = 80;
    std::string shown = uri.substr(0, kLongest);
    for (char& c : shown) {
        if (std::iscntrl(static_cast<unsigned char>(c))) c = '?';
    }
    return uri.size() > kLongest ? shown + "..." : shown;
}

GltfText read_gltf_text(const fs::path& file, const std::string& name, const BeforeBytes& before) {
    GltfText out;
    out.file = read_file_bytes(file, name, before);
    out.json = as_text(out.file);
    const auto glb = read_glb_header(out.file, out.file.size(), name);
    if (glb) split_glb(out, glb->length, name);
    return out;
}

Bytes read_gltf_json(const fs::path& file, const BeforeBytes& before) {
    const std::string name = file.string();
    std::uint64_t size = size_of_file(file, name);
    std::ifstream in(file, std::ios::binary);
    const Bytes first = read_next(in, std::min<std::uint64_t>(size, kFirstBytes), name);
    if (const auto glb = read_glb_header(first, size, name)) {
        size = std::min<std::uint64_t>(size - kFirstBytes, glb->json_length);
    } else {
        in.seekg(0);
    }
    before(size);
    return read_next(in, size, name);
}

bool is_data_uri(std::string_view uri) { return lower(uri.substr(0, 5)) == "data:"; }

Bytes read_uri(const UriBase& base, const std::string& uri, const std::string& where,
               const BeforeBytes& before) {
    const std::string place = base.file + ": " + where;
    if (is_data_uri(uri)) return read_data_uri(uri, place, before);
    return read_file_bytes(path_of_uri(base, uri, place), place + ": file '" + shown_uri(uri) + "'",
                           before);
}

}  // namespace kilolux
