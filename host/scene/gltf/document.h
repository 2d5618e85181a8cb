// SPDX-License-Identifier: Apache-2.0
#pragma once

// The library is built without stb; images go through OpenImageIO.
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

#include <atomic>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "host/scene/gltf/load_scene.h"
#include "host/scene/gltf/uri.h"

namespace kilolux {

/// What decoding a file may still allocate, so that a small broken file cannot claim all memory.
class ByteBudget {
 public:
    explicit ByteBudget(std::uint64_t limit) : limit_(limit), left_(limit) {}

    /// Takes count * bytes_each; throws Error "<where>: needs ..." when that is more than is left.
    void charge(std::uint64_t count, std::uint64_t bytes_each, const std::string& where);

    /// Gives back all that was taken: what is decoded from now on replaces what was decoded before.
    void refill() { left_ = limit_; }

 private:
    std::uint64_t limit_;
    std::atomic<std::uint64_t> left_;
};

/// A glTF file whose JSON is checked and whose buffers are in memory.
///
/// Every index of `model` is in range except those that are relative to another element (an
/// animation's samplers, a skin's joints in JOINTS_n, vertex indices).
struct GltfDocument {
    UriBase base;
    LoadOptions options;
    tinygltf::Model model;  // without buffers; images keep uri, bufferView and mimeType only
    std::vector<Bytes> buffers;
    std::vector<std::span<const unsigned char>> views;  // one per buffer view, decompressed
    std::vector<Bytes> decompressed;                    // what views of compressed data point into
    std::unique_ptr<ByteBudget> budget;

    /// Throws Error "<file>: <where>: <what>".
    [[noreturn]] void fail(const std::string& where, const std::string& what) const;
};

/// "accessors[7]".
std::string element_name(const char* array, std::size_t element);

/// A double of the file as a float; beyond its range infinite.
float to_float(double value);

/// Reads and checks a file up to, not including, the contents of its accessors and images.
GltfDocument load_gltf_document(const std::filesystem::path& file, const LoadOptions& options);

}  // namespace kilolux
