// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/gltf/document.h"

namespace kilolux {

/// An accessor's elements in memory, checked to lie within their buffer view.
struct ElementArray {
    std::string where;  // "scene.gltf: accessors[7]", for messages
    int component_type = TINYGLTF_COMPONENT_TYPE_FLOAT;
    std::size_t components = 1;  // 1 to 4, or 4, 9, 16 of a matrix
    std::size_t count = 0;
    bool normalized = false;
    std::size_t stride = 0;                        // [byte]
    std::span<const unsigned char> bytes;          // from element 0; empty: all elements are zero
    std::vector<std::uint32_t> sparse_elements;    // ascending; elements that are replaced by
    std::span<const unsigned char> sparse_values;  // these, tightly packed
};

/// Throws Error when the accessor leaves its buffer view, or its sparse part is out of order.
ElementArray open_accessor(const GltfDocument& document, int accessor);

/// An element's components, normalised integers mapped to [0, 1] or [-1, 1]; those that
/// the type lacks are 0. Throws Error when one is not finite as a float.
glm::dvec4 read_exact(const ElementArray& array, std::size_t element);

/// The same rounded to floats, which only the type of 64 bits needs.
glm::vec4 read_vector(const ElementArray& array, std::size_t element);

/// A component of a SCALAR accessor.
float read_scalar(const ElementArray& array, std::size_t element);

/// An element of a MAT4 accessor.
glm::dmat4 read_matrix(const ElementArray& array, std::size_t element);

/// An element of a SCALAR accessor of unsigned integers.
std::uint32_t read_index(const ElementArray& array, std::size_t element);

/// Calls `visit` with a zero of the C++ type that an accessor's componentType stands for.
template <typename Visitor>
auto visit_component_type(int component_type, const Visitor& visit) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return visit(std::int8_t{});
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return visit(std::uint8_t{});
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return visit(std::int16_t{});
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return visit(std::uint16_t{});
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return visit(std::uint32_t{});
        case TINYGLTF_COMPONENT_TYPE_DOUBLE:
            return visit(0.0);
        default:
            return visit(0.0f);
    }
}

/// Bytes of a component of a type that accessors may have.
std::size_t component_bytes(int component_type);

/// Throws Error unless the array has one of the numbers of components.
void expect_components(const ElementArray& array, std::initializer_list<std::size_t> allowed,
                       const std::string& what);

}  // namespace kilolux
