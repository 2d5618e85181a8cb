// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/material/image.h"

#include <fmt/core.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <string_view>

#include "host/base/error.h"

namespace kilolux {
namespace {

using PngBytes = std::span<const unsigned char>;

constexpr std::array<unsigned char, 8> kSignature = {0x89, 'P', 'N', 'G', 13, 10, 26, 10};
constexpr std::size_t kFrameBytes = 12;  // of a chunk: length, type, checksum
// The chunks that pixels depend on: the critical ones and transparency.
constexpr std::array<std::string_view, 5> kNeeded = {"IHDR", "PLTE", "IDAT", "IEND", "tRNS"};

std::uint32_t big_endian(PngBytes bytes) {
    return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 |
           std::uint32_t{bytes[2]} << 8 | std::uint32_t{bytes[3]};
}

struct Chunk {
    PngBytes bytes;  // all of it
    std::size_t offset = 0;
    std::string_view type;
};

Chunk png_chunk_at(PngBytes png, std::size_t offset, const std::string& where) {
    const PngBytes rest = png.subspan(offset);
    if (rest.size() < kFrameBytes || big_endian(rest) > rest.size() - kFrameBytes) {
        throw Error(
            fmt::format("{}: is cut off in the chunk at byte {} of {}", where, offset, png.size()));
    }
    return {rest.first(kFrameBytes + big_endian(rest)), offset,
            std::string_view(reinterpret_cast<const char*>(rest.data()) + 4, 4)};
}

[[noreturn]] void fail(const Chunk& chunk, const std::string& where, const char* what) {
    std::string type(chunk.type);
    for (char& c : type) {
        if (!std::isalpha(static_cast<unsigned char>(c))) c = '?';
    }
    throw Error(fmt::format("{}: chunk {} at byte {} {}", where, type, chunk.offset, what));
}

// Throws when a decoder must read the chunk and cannot. Broken chunks that it may skip pass.
void check_chunk(const Chunk& chunk, const std::string& where) {
    if (std::find(kNeeded.begin(), kNeeded.end(), chunk.type) == kNeeded.end()) {
        if (std::islower(static_cast<unsigned char>(chunk.type[0]))) return;
        fail(chunk, where, "is of no type that PNG decoders know");
    }
    const PngBytes bytes = chunk.bytes;
    const PngBytes checked = bytes.subspan(4, bytes.size() - 8);  // type and data
    if (crc32_z(0, checked.data(), checked.size()) != big_endian(bytes.last(4))) {
        fail(chunk, where, "is damaged: its checksum is wrong");
    }
    if ((chunk.offset == kSignature.size()) != (chunk.type == "IHDR")) {
        fail(chunk, where, "is out of place: IHDR is the first chunk and no other");
    }
}

}  // namespace

void check_png(PngBytes png, const std::string& where) {
    const bool starts = png.size() >= kSignature.size() &&
                        std::equal(kSignature.begin(), kSignature.end(), png.begin());
    if (!starts) throw Error(where + ": does not start as a PNG file does");
    bool has_pixels = false;
    for (std::size_t offset = kSignature.size(); offset < png.size();) {
        const Chunk chunk = png_chunk_at(png, offset, where);
        check_chunk(chunk, where);
        if (chunk.type == "IEND") break;
        has_pixels = has_pixels || chunk.type == "IDAT";
        offset += chunk.bytes.size();
    }
    if (!has_pixels) throw Error(where + ": has no chunk IDAT, which holds a PNG's pixels");
}

}  // namespace kilolux
