// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/accessor.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "host/base/error.h"

namespace kilolux {
namespace {

template <typename T>
T load(const unsigned char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

// glTF 2.0, section 3.11 (accessors of normalized integers).
float component_value(const ElementArray& array, const unsigned char* bytes) {
    switch (array.component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE: {
            const float value = load<std::int8_t>(bytes);
            return array.normalized ? std::max(value / 127.0f, -1.0f) : value;
        }
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: {
            const float value = load<std::uint8_t>(bytes);
            return array.normalized ? value / 255.0f : value;
        }
        case TINYGLTF_COMPONENT_TYPE_SHORT: {
            const float value = load<std::int16_t>(bytes);
            return array.normalized ? std::max(value / 32767.0f, -1.0f) : value;
        }
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: {
            const float value = load<std::uint16_t>(bytes);
            return array.normalized ? value / 65535.0f : value;
        }
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: {
            const double value = load<std::uint32_t>(bytes);
            return static_cast<float>(array.normalized ? value / 4294967295.0 : value);
        }
        default:
            return load<float>(bytes);
    }
}

float finite_component(const ElementArray& array, std::size_t element, std::size_t component,
                       const unsigned char* bytes) {
    const std::size_t size = component_bytes(array.component_type);
    const float value = component_value(array, bytes + component * size);
    if (!std::isfinite(value)) {
        throw Error(array.where + ": element " + std::to_string(element) + " holds " +
                    std::to_string(value) + ", must be finite");
    }
    return value;
}

std::size_t element_bytes(const ElementArray& array) {
    return component_bytes(array.component_type) * array.components;
}

// Where an element's components stand; nullptr for an element of zeros.
const unsigned char* element_at(const ElementArray& array, std::size_t element) {
    const auto& sparse = array.sparse_elements;
    const auto found = std::lower_bound(sparse.begin(), sparse.end(), element);
    if (found != sparse.end() && *found == element) {
        const auto index = static_cast<std::size_t>(found - sparse.begin());
        return array.sparse_values.data() + index * element_bytes(array);
    }
    return array.bytes.empty() ? nullptr : array.bytes.data() + element * array.stride;
}

// The bytes of `count` elements of `size` bytes from `offset` of a buffer view on.
std::span<const unsigned char> elements_of_view(const GltfDocument& document, int view,
                                                std::size_t offset, std::size_t last_end,
                                                const std::string& where) {
    const auto bytes = document.views[static_cast<std::size_t>(view)];
    if (offset > bytes.size() || last_end > bytes.size() - offset) {
        throw Error(where + ": needs " + std::to_string(last_end) + " bytes from byte " +
                    std::to_string(offset) + " of bufferViews[" + std::to_string(view) +
                    "], which has " + std::to_string(bytes.size()));
    }
    return bytes.subspan(offset, last_end);
}

// The sparse part's values and the elements that they replace.
void open_sparse(const GltfDocument& document, const tinygltf::Accessor& accessor,
                 ElementArray& array) {
    const auto& sparse = accessor.sparse;
    const auto count = static_cast<std::size_t>(sparse.count);
    ElementArray indices;
    indices.where = array.where + ".sparse.indices";
    indices.component_type = sparse.indices.componentType;
    indices.stride = component_bytes(indices.component_type);
    indices.bytes = elements_of_view(document, sparse.indices.bufferView,
                                     static_cast<std::size_t>(sparse.indices.byteOffset),
                                     count * indices.stride, indices.where);
    array.sparse_values = elements_of_view(
        document, sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset),
        count * element_bytes(array), array.where + ".sparse.values");
    document.budget->charge(count, sizeof(std::uint32_t), indices.where);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t element = read_index(indices, i);
        const bool ascends = i == 0 || element > array.sparse_elements.back();
        if (element >= array.count || !ascends) {
            throw Error(indices.where + ": value " + std::to_string(i) + " is " +
                        std::to_string(element) + ", must ascend and be below " +
                        std::to_string(array.count));
        }
        array.sparse_elements.push_back(element);
    }
}

}  // namespace

std::size_t component_bytes(int component_type) {
    return static_cast<std::size_t>(
        tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(component_type)));
}

ElementArray open_accessor(const GltfDocument& document, int index) {
    const auto accessor_index = static_cast<std::size_t>(index);
    const tinygltf::Accessor& accessor = document.model.accessors[accessor_index];
    ElementArray array;
    array.where = document.base.file + ": " + element_name("accessors", accessor_index);
    array.component_type = accessor.componentType;
    array.components = static_cast<std::size_t>(
        tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
    array.count = accessor.count;
    array.normalized = accessor.normalized;
    const std::size_t size = element_bytes(array);
    array.stride = size;
    if (accessor.bufferView >= 0) {
        const auto& view =
            document.model.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
        if (view.byteStride != 0) array.stride = view.byteStride;
        const std::size_t end = array.count == 0 ? 0 : (array.count - 1) * array.stride + size;
        array.bytes =
            elements_of_view(document, accessor.bufferView, accessor.byteOffset, end, array.where);
    }
    if (accessor.sparse.isSparse) open_sparse(document, accessor, array);
    return array;
}

glm::vec4 read_vector(const ElementArray& array, std::size_t element) {
    glm::vec4 out(0.0f);
    const unsigned char* bytes = element_at(array, element);
    if (bytes == nullptr) return out;
    const std::size_t components = std::min<std::size_t>(array.components, 4);
    for (std::size_t c = 0; c < components; ++c) {
        out[static_cast<glm::length_t>(c)] = finite_component(array, element, c, bytes);
    }
    return out;
}

float read_scalar(const ElementArray& array, std::size_t element) {
    return read_vector(array, element).x;
}

glm::dmat4 read_matrix(const ElementArray& array, std::size_t element) {
    glm::dmat4 out(0.0);
    const unsigned char* bytes = element_at(array, element);
    if (bytes == nullptr) return out;
    for (glm::length_t c = 0; c < 16; ++c) {
        out[c / 4][c % 4] = finite_component(array, element, static_cast<std::size_t>(c), bytes);
    }
    return out;
}

std::uint32_t read_index(const ElementArray& array, std::size_t element) {
    const unsigned char* bytes = element_at(array, element);
    if (bytes == nullptr) return 0;
    switch (array.component_type) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return load<std::uint8_t>(bytes);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return load<std::uint16_t>(bytes);
        default:
            return load<std::uint32_t>(bytes);
    }
}

void expect_components(const ElementArray& array, std::initializer_list<std::size_t> allowed,
                       const std::string& what) {
    if (std::find(allowed.begin(), allowed.end(), array.components) != allowed.end()) return;
    throw Error(array.where + ": has " + std::to_string(array.components) + " components, which " +
                what + " cannot have");
}

}  // namespace kilolux
