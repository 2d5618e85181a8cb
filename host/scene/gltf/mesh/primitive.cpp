// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/mesh/primitive.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>

#include "host/scene/gltf/mesh/draco.h"

namespace kilolux {
namespace {

AttributeArrays open_attributes(const GltfDocument& document,
                                const std::map<std::string, int>& attributes) {
    AttributeArrays arrays;
    for (const auto& [name, accessor] : attributes) {
        // Names that start with an underscore are application-specific.
        if (!name.starts_with("_")) arrays.emplace(name, open_accessor(document, accessor));
    }
    return arrays;
}

void check_counts(const PrimitiveArrays& arrays, const AttributeArrays& attributes) {
    for (const auto& [name, array] : attributes) {
        if (array.count >= arrays.vertex_count) continue;
        throw Error(fmt::format("{}: {} has {} elements, POSITION has {}", arrays.where, name,
                                array.count, arrays.vertex_count));
    }
}

std::vector<std::uint32_t> read_indices(const GltfDocument& document, const PrimitiveArrays& arrays,
                                        int accessor) {
    if (accessor < 0) {
        document.budget->charge(arrays.vertex_count, 4 * sizeof(std::uint32_t), arrays.where);
        std::vector<std::uint32_t> indices(arrays.vertex_count);
        std::iota(indices.begin(), indices.end(), 0u);
        return indices;
    }
    const ElementArray array = open_accessor(document, accessor);
    expect_components(array, {1}, "indices");
    if (array.component_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
        array.component_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        array.component_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
        throw Error(fmt::format("{}: componentType is {}, must be unsigned for indices",
                                array.where, array.component_type));
    }
    document.budget->charge(array.count, 4 * sizeof(std::uint32_t), array.where);
    std::vector<std::uint32_t> indices(array.count);
    for (std::size_t i = 0; i < indices.size(); ++i) {
        indices[i] = read_index(array, i);
        if (indices[i] < arrays.vertex_count) continue;
        throw Error(fmt::format("{}: index {} is {}, must be below the {} vertices of {}",
                                array.where, i, indices[i], arrays.vertex_count, arrays.where));
    }
    return indices;
}

int corners_of_mode(int mode) {
    if (mode == TINYGLTF_MODE_POINTS) return 1;
    return mode < TINYGLTF_MODE_TRIANGLES ? 2 : 3;
}

// Elements (points, segments, triangles) of a mode with that many indices.
std::size_t element_count(int mode, std::size_t indices) {
    const auto beyond = [indices](std::size_t first) { return std::max(indices, first) - first; };
    switch (mode) {
        case TINYGLTF_MODE_POINTS:
            return indices;
        case TINYGLTF_MODE_LINE:
            return indices / 2;
        case TINYGLTF_MODE_LINE_LOOP:
            return indices < 2 ? 0 : indices;
        case TINYGLTF_MODE_LINE_STRIP:
            return beyond(1);
        case TINYGLTF_MODE_TRIANGLES:
            return indices / 3;
        default:
            return beyond(2);
    }
}

// Place of an element's corner in the index list (glTF 2.0, section 3.7.2.1).
std::size_t corner_of(int mode, std::size_t element, std::size_t corner) {
    switch (mode) {
        case TINYGLTF_MODE_LINE_LOOP:
        case TINYGLTF_MODE_LINE_STRIP:
            return element + corner;
        case TINYGLTF_MODE_TRIANGLE_FAN:
            return corner == 2 ? 0 : element + corner + 1;
        case TINYGLTF_MODE_TRIANGLE_STRIP:
            return element + (element % 2 == 0 || corner == 0 ? corner : 3 - corner);
        default:
            return static_cast<std::size_t>(corners_of_mode(mode)) * element + corner;
    }
}

bool names_a_vertex_twice(std::span<const std::uint32_t> element) {
    for (std::size_t c = 1; c < element.size(); ++c) {
        if (element[c] == element[c - 1] || element[c] == element[0]) return true;
    }
    return false;
}

// The elements one by one, without strips, loops and fans.
std::vector<std::uint32_t> element_list(const std::vector<std::uint32_t>& indices, int mode) {
    const auto corners_each = static_cast<std::size_t>(corners_of_mode(mode));
    const std::size_t count = element_count(mode, indices.size());
    std::vector<std::uint32_t> corners;
    corners.reserve(corners_each * count);
    std::array<std::uint32_t, 3> element{};
    for (std::size_t e = 0; e < count; ++e) {
        for (std::size_t c = 0; c < corners_each; ++c) {
            const std::size_t place = corner_of(mode, e, c);
            element[c] = indices[place < indices.size() ? place : 0];  // a loop ends where it began
        }
        const std::span<const std::uint32_t> own(element.data(), corners_each);
        if (!names_a_vertex_twice(own)) corners.insert(corners.end(), own.begin(), own.end());
    }
    return corners;
}

}  // namespace

int corners_of(const tinygltf::Primitive& primitive) { return corners_of_mode(primitive.mode); }

bool is_drawable(const GltfDocument& document, const tinygltf::Primitive& primitive) {
    if (!primitive.attributes.contains("POSITION")) {
        document.leave_out("primitives without positions are left out");
        return false;
    }
    return true;
}

PrimitiveArrays open_primitive(const GltfDocument& document, const tinygltf::Primitive& primitive,
                               const std::string& where) {
    PrimitiveArrays arrays;
    arrays.where = where;
    arrays.attributes = open_attributes(document, primitive.attributes);
    arrays.vertex_count = arrays.attributes.at("POSITION").count;
    arrays.corners_each = corners_of(primitive);
    if (is_draco_compressed(primitive)) {
        if (arrays.corners_each < 3) {
            throw Error(fmt::format("{}: mode is {}, Draco compresses triangles only", where,
                                    primitive.mode));
        }
        const auto indices = decode_draco_primitive(document, primitive, arrays);
        arrays.corners = element_list(indices, TINYGLTF_MODE_TRIANGLES);
    } else {
        const auto indices = read_indices(document, arrays, primitive.indices);
        arrays.corners = element_list(indices, primitive.mode);
    }
    check_counts(arrays, arrays.attributes);
    for (const auto& target : primitive.targets) {
        arrays.targets.push_back(open_attributes(document, target));
        check_counts(arrays, arrays.targets.back());
    }
    return arrays;
}

}  // namespace kilolux
