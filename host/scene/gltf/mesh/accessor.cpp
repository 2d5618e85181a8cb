// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/mesh/accessor.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace kilolux {
namespace {

template <typename T>
T load(const unsigned char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

// glTF 2.0, section 3.11 (accessors of normalized integers).
double component_value(const ElementArray& array, const unsigned char* bytes) {
    return visit_component_type(array.component_type, [&](auto zero) {
        using T = decltype(zero);
        const T value = load<T>(bytes);
        if (std::is_floating_point_v<T> || !array.normalized) return static_cast<double>(value);
        using Real = std::conditional_t<sizeof(T) == 4, double, float>;
        const Real largest = static_cast<Real>(std::numeric_limits<T>::max());
        // A float has it all.
        return double{static_cast<float>(std::max(static_cast<Real>(value) / largest, Real{-1}))};
    });
}

double finite_component(const ElementArray& array, std::size_t element, std::size_t component,
                        const unsigned char* bytes) {
    const std::size_t size = component_bytes(array.component_type);
    const double value = component_value(array, bytes + component * size);
    if (std::isfinite(to_float(value))) return value;
    throw Error(
        fmt::format("{}: element {} holds {}, must be finite", array.where, element, value));
}

std::size_t element_bytes(const ElementArray& array) {
    return component_bytes(array.component_type) * array.components;
}

// An element's components in memory; nullptr for an element of zeros.
const unsigned char* element_at(const ElementArray& array, std::size_t element) {
    const auto& sparse = array.sparse_elements;
    const auto found = std::lower_bound(sparse.begin(), sparse.end(), element);
    if (found != sparse.end() && *found == element) {
        const auto index = static_cast<std::size_t>(found - sparse.begin());
        return array.sparse_values.data() + index * element_bytes(array);
    }
    return array.bytes.empty() ? nullptr : array.bytes.data() + element * array.stride;
}

// `size` bytes of a buffer view from `offset` on.
std::span<const unsigned char> bytes_of_view(const GltfDocument& document, int view,
                                             std::size_t offset, std::size_t size,
                                             const std::string& where) {
    const auto bytes = document.views[static_cast<std::size_t>(view)];
    if (offset > bytes.size() || size > bytes.size() - offset) {
        throw Error(fmt::format("{}: needs {} bytes from byte {} of bufferViews[{}], which has {}",
                                where, size, offset, view, bytes.size()));
    }
    return bytes.subspan(offset, size);
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
    indices.bytes = bytes_of_view(document, sparse.indices.bufferView,
                                  static_cast<std::size_t>(sparse.indices.byteOffset),
                                  count * indices.stride, indices.where);
    array.sparse_values = bytes_of_view(
        document, sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset),
        count * element_bytes(array), array.where + ".sparse.values");
    document.budget->charge(count, sizeof(std::uint32_t), indices.where);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t element = read_index(indices, i);
        const bool ascends = i == 0 || element > array.sparse_elements.back();
        if (element >= array.count || !ascends) {
            throw Error(fmt::format("{}: value {} is {}, must ascend and be below {}",
                                    indices.where, i, element, array.count));
        }
        array.sparse_elements.push_back(element);
    }
}

}  // namespace

std::size_t component_bytes(int component_type) {
    return visit_component_type(component_type, [](auto zero) { return sizeof zero; });
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
            bytes_of_view(document, accessor.bufferView, accessor.byteOffset, end, array.where);
    }
    if (accessor.sparse.isSparse) open_sparse(document, accessor, array);
    return array;
}

glm::dvec4 read_exact(const ElementArray& array, std::size_t element) {
    glm::dvec4 out(0.0);
    const unsigned char* bytes = element_at(array, element);
    if (bytes == nullptr) return out;
    const std::size_t components = std::min<std::size_t>(array.components, 4);
    for (std::size_t c = 0; c < components; ++c) {
        out[static_cast<glm::length_t>(c)] = finite_component(array, element, c, bytes);
    }
    return out;
}

glm::vec4 read_vector(const ElementArray& array, std::size_t element) {
    return glm::vec4(read_exact(array, element));
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
    return visit_component_type(array.component_type, [bytes](auto zero) -> std::uint32_t {
        using T = decltype(zero);
        if constexpr (std::is_unsigned_v<T>) return load<T>(bytes);
        return 0;  // no file gets here: indices of other types are refused
    });
}

void expect_components(const ElementArray& array, std::initializer_list<std::size_t> allowed,
                       const std::string& what) {
    if (std::find(allowed.begin(), allowed.end(), array.components) != allowed.end()) return;
    throw Error(fmt::format("{}: has {} components, which {} cannot have", array.where,
                            array.components, what));
}

}  // namespace kilolux
