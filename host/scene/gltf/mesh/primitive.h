// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "host/scene/gltf/mesh/accessor.h"

namespace kilolux {

using AttributeArrays = std::map<std::string, ElementArray>;

/// Vertices of a point, segment or triangle of a primitive: 1, 2 or 3.
int corners_of(const tinygltf::Primitive& primitive);

/// A primitive's vertex attributes and its points, segments or triangles, opened but not yet
/// converted.
struct PrimitiveArrays {
    std::string where;  // "scene.gltf: meshes[2].primitives[0]", for messages
    AttributeArrays attributes;
    std::vector<AttributeArrays> targets;  // morph targets
    std::size_t vertex_count = 0;
    int corners_each = 3;                // of a triangle; 2 of a segment, 1 of a point
    std::vector<std::uint32_t> corners;  // corners_each per triangle, each < vertex_count
    std::vector<Bytes> decoded;          // what attributes of compressed primitives point into
};

/// Whether a primitive has positions; warns once when it has not.
bool is_drawable(const GltfDocument& document, const tinygltf::Primitive& primitive);

/// Opens a drawable primitive. Strips, loops and fans become lists; triangles and segments that
/// name a vertex twice are left out. Throws Error for indices out of range and attributes of
/// unequal counts.
PrimitiveArrays open_primitive(const GltfDocument& document, const tinygltf::Primitive& primitive,
                               const std::string& where);

}  // namespace kilolux
