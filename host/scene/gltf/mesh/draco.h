// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/gltf/mesh/primitive.h"

namespace kilolux {

/// Whether a primitive's attributes and indices are compressed (KHR_draco_mesh_compression).
bool is_draco_compressed(const tinygltf::Primitive& primitive);

/// Decodes such a primitive: its attributes in `arrays` then read the decoded values, which
/// `arrays` keeps. Returns the triangles' vertex indices, 3 each.
std::vector<std::uint32_t> decode_draco_primitive(const GltfDocument& document,
                                                  const tinygltf::Primitive& primitive,
                                                  PrimitiveArrays& arrays);

}  // namespace kilolux
