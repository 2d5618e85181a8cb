// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/support/gltf_builder.h"

namespace kilolux {

/// How EXT_meshopt_compression holds a buffer view.
struct Meshopt {
    std::string mode;
    std::string filter = "NONE";
    std::size_t count = 0;
    std::size_t stride = 0;
};

/// Adds a buffer view that holds `encoded`; its decoded bytes would stand in buffer 1.
int add_meshopt_view(GltfBuilder& file, const Blob& encoded, const Meshopt& meshopt);

/// Adds buffer 1, which holds nothing, once all views are added. For GLBs.
void add_fallback_buffer(GltfBuilder& file);

Blob encode_vertices(const void* vertices, std::size_t count, std::size_t stride);

/// Adds a node with a unit quad whose positions and indices are compressed ("TRIANGLES" or
/// "INDICES"); the fallback buffer is still to be added.
void add_meshopt_quad(GltfBuilder& file, const std::string& index_mode);

/// A file of such a quad alone.
GltfBuilder meshopt_quad(const std::string& index_mode);

/// The same with KHR_meshopt_compression: version 1 of the vertex format, and colours through the
/// filter COLOR: 0 0 0 0, 255 255 255 255, 254 1 0 128, 10 200 30 76.
GltfBuilder khr_meshopt_quad();

/// The bytes that hexadecimal digits stand for.
Blob hex_bytes(const std::string& digits);

constexpr int kDracoSequential = 0;
constexpr int kDracoEdgebreaker = 1;

/// The quad as a Draco bit stream; attribute 0 is the position, 1 a red colour of bytes.
Blob draco_quad(int encoding_method);

/// Adds a node with a primitive that is such a stream.
void add_draco_quad(GltfBuilder& file, const Blob& encoded);

/// A file of such a primitive alone.
GltfBuilder draco_file(const Blob& encoded);

}  // namespace kilolux
