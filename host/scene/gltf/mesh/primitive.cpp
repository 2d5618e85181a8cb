// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/mesh/primitive.h"

#include <numeric>

#include "host/base/log.h"

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

// The corner of a strip's or fan's triangle t in its index list (glTF 2.0, section 3.7.2.1).
std::size_t corner_of(int mode, std::size_t t, std::size_t corner) {
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN) return corner == 2 ? 0 : t + corner + 1;
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
        const std::size_t swapped = corner == 0 ? 0 : 3 - corner;
        return t + (t % 2 == 0 ? corner : swapped);
    }
    return 3 * t + corner;
}

std::vector<std::uint32_t> triangle_list(const std::vector<std::uint32_t>& indices, int mode) {
    const bool is_list = mode == TINYGLTF_MODE_TRIANGLES;
    const std::size_t count = is_list               ? indices.size() / 3
                              : indices.size() >= 3 ? indices.size() - 2
                                                    : 0;
    std::vector<std::uint32_t> corners;
    corners.reserve(3 * count);
    for (std::size_t t = 0; t < count; ++t) {
        const std::uint32_t a = indices[corner_of(mode, t, 0)];
        const std::uint32_t b = indices[corner_of(mode, t, 1)];
        const std::uint32_t c = indices[corner_of(mode, t, 2)];
        if (a != b && b != c && c != a) corners.insert(corners.end(), {a, b, c});
    }
    return corners;
}

}  // namespace

bool is_drawable(const GltfDocument& document, const tinygltf::Primitive& primitive) {
    if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
        warn(document.base.file + ": points and lines are left out");
        return false;
    }
    if (!primitive.attributes.contains("POSITION")) {
        warn(document.base.file + ": primitives without positions are left out");
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
    if (is_draco_compressed(primitive)) {
        const auto indices = decode_draco_primitive(document, primitive, arrays);
        arrays.corners = triangle_list(indices, TINYGLTF_MODE_TRIANGLES);
    } else {
        const auto indices = read_indices(document, arrays, primitive.indices);
        arrays.corners = triangle_list(indices, primitive.mode);
    }
    check_counts(arrays, arrays.attributes);
    for (const auto& target : primitive.targets) {
        arrays.targets.push_back(open_attributes(document, target));
        check_counts(arrays, arrays.targets.back());
    }
    return arrays;
}

}  // namespace kilolux
