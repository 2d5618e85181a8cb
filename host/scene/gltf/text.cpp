// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/text.h"

#include <cstring>
#include <span>

#include "host/base/error.h"

namespace kilolux {
namespace {

// glTF 2.0 specification, section 4.4 (binary glTF layout); all little-endian.
constexpr std::uint32_t kMagic = 0x46546C67;      // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004E4942;   // "BIN\0"
constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;

std::uint32_t read_u32(std::span<const unsigned char> bytes, std::size_t offset) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

// The chunk at `offset`; throws when its claimed length does not fit.
std::span<const unsigned char> chunk_at(std::span<const unsigned char> bytes, std::size_t offset,
                                        const std::string& name) {
    const std::size_t length = read_u32(bytes, offset);
    const std::size_t left = bytes.size() - offset - kChunkHeaderBytes;
    if (length > left) {
        throw Error(name + ": GLB chunk at byte " + std::to_string(offset) + " claims " +
                    std::to_string(length) + " bytes, the file holds " + std::to_string(left));
    }
    return bytes.subspan(offset + kChunkHeaderBytes, length);
}

GltfText split_glb(std::span<const unsigned char> bytes, const std::string& name) {
    if (bytes.size() < kHeaderBytes + kChunkHeaderBytes) {
        throw Error(name + ": GLB of " + std::to_string(bytes.size()) +
                    " bytes is shorter than its headers");
    }
    if (const std::uint32_t version = read_u32(bytes, 4); version != 2) {
        throw Error(name + ": GLB version is " + std::to_string(version) + ", must be 2");
    }
    const std::size_t length = read_u32(bytes, 8);
    if (length > bytes.size() || length < kHeaderBytes + kChunkHeaderBytes) {
        throw Error(name + ": GLB header claims " + std::to_string(length) +
                    " bytes, the file holds " + std::to_string(bytes.size()));
    }
    bytes = bytes.first(length);
    if (read_u32(bytes, kHeaderBytes + 4) != kJsonChunk) {
        throw Error(name + ": the first chunk of the GLB is not JSON");
    }
    GltfText out;
    const auto json = chunk_at(bytes, kHeaderBytes, name);
    out.json.assign(json.begin(), json.end());
    std::size_t offset = kHeaderBytes + kChunkHeaderBytes + (json.size() + 3) / 4 * 4;
    // Chunks of other types may stand anywhere after the first and are skipped (section 4.4.3.1).
    while (!out.has_binary && offset + kChunkHeaderBytes <= bytes.size()) {
        const auto chunk = chunk_at(bytes, offset, name);
        if (read_u32(bytes, offset + 4) == kBinChunk) {
            out.has_binary = true;
            out.binary.assign(chunk.begin(), chunk.end());
        }
        offset += kChunkHeaderBytes + (chunk.size() + 3) / 4 * 4;
    }
    return out;
}

}  // namespace

GltfText read_gltf_text(const std::filesystem::path& file, const std::string& name) {
    const Bytes bytes = read_file_bytes(file, name);
    if (bytes.size() >= 4 && read_u32(bytes, 0) == kMagic) return split_glb(bytes, name);
    return {std::string(bytes.begin(), bytes.end()), {}, false};
}

}  // namespace kilolux
